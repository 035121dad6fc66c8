// Forces by row as wrenches, and loads that joints share. References: the virtual work of a wrench
// at the anchor in any motion of the bodies; the least squares solution of least norm by a dense
// complete orthogonal decomposition (Eigen).
#include "engine/dynamics/joints/joint_wrench.hpp"

#include "engine/core/random.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/joint_world.hpp"
#include "tests/support/dense.hpp"

#include <numeric>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double arm = 0.3;  ///< of a torque in the sum of squares [m]

/// Bodies in a ring, with a second joint somewhere and one to the world.
struct Ring : JointWorld {
  Ring(Random& random, uint32_t bodies_count) {
    for (uint32_t i = 0; i < bodies_count; ++i) {
      BodyDef d = body(box(0.3, 0.2, 0.1), {double(i), random.uniform(-1, 1), 0});
      d.mass = random.uniform(0.5, 3);
      d.pose.q = axis_angle(Vec3(1, 2, 3).normalized(), random.uniform(0, 3));
      add(d);
    }
    // The last kind is free: nothing is kept, so nothing is shared.
    const auto kind = [&] {
      return all_joint_kinds()[random.below(uint32_t(all_joint_kinds().size() - 1))].kind;
    };
    const auto at = [&](uint32_t i) -> Pose {
      return {bodies[i].pose.x + Vec3(0.4, 0.1, 0.2), bodies[i].pose.q};
    };
    for (uint32_t i = 0; i < bodies_count; ++i) join(kind(), i, (i + 1) % bodies_count, at(i));
    join(JointKind::rigid, 0, 1, at(1));
    join(JointKind::revolute, no_body, 0, at(0));
    join(kind(), no_body, 0, at(0));
  }
};

/// J^T with rows of torque counted by the arm; sizes are by row [1] or [1/m].
Eigen::MatrixXd pushes_of(const Articulation& joints, size_t blocks, Eigen::VectorXd& sizes) {
  Eigen::MatrixXd out =
      Eigen::MatrixXd::Zero(Eigen::Index(6 * blocks), Eigen::Index(joints.size()));
  sizes.resize(out.cols());
  for (Eigen::Index r = 0; r < out.cols(); ++r) {
    const Row& row = joints.rows()[size_t(r)].row;
    sizes[r] = row.b.linear.norm() > 0 ? 1 : 1 / arm;
    for (const RowSide* s : {&row.a, &row.b}) {
      if (s->block == no_block) continue;
      out.col(r).segment<3>(6 * Eigen::Index(s->block)) += dense(s->linear) / sizes[r];
      out.col(r).segment<3>(6 * Eigen::Index(s->block) + 3) += dense(s->angular) / sizes[r];
    }
  }
  return out;
}

}  // namespace

TEST_CASE("the wrench of a joint does the work of its rows in any motion") {
  Random random(5);
  for (const JointKindEntry& kind : all_joint_kinds()) {
    INFO(kind.name);
    JointWorld w;
    for (const double x : {-0.5, 0.7}) w.add(body(box(0.3, 0.2, 0.1), {x, 0.3 * x, 0}));
    Joint& joint = w.join(kind.kind, 0, 1, {{0.1, 0.2, 0.3}, Quat(0.5, 0.5, -0.5, 0.5)});
    if (kind.kind == JointKind::distance) {
      joint.frame_b.x += Vec3(0, 0.4, 0.1);
      joint.length = 1;
    }
    const JointSides sides = joint_sides(joint, w.bodies);
    JointRows rows;
    joint_rows(kind.kind, sides, rows);
    for (size_t i = 0; i < rows.size(); ++i) {
      joint.moving_force[i] = random.uniform(-5, 5);
      joint.relaxing_force[i] = random.uniform(-1, 1);
    }
    const JointWrench wrench = wrench_of_rows(joint, sides);
    std::array<DofBlock, 2> blocks;
    for (DofBlock& b : blocks)
      for (int k = 0; k < 3; ++k)
        b.v[k] = random.uniform(-1, 1), b.omega[k] = random.uniform(-1, 1);
    double work = 0;
    for (size_t i = 0; i < rows.size(); ++i)
      work += (joint.moving_force[i] + joint.relaxing_force[i]) * row_velocity(rows[i].row, blocks);
    // B's anchor, and the same point of A.
    const Vec3 arm_a = sides.b.anchor() - sides.a.x;
    const Vec3 u = blocks[1].v + blocks[1].omega.cross(sides.b.arm) - blocks[0].v -
                   blocks[0].omega.cross(arm_a);
    const double power = wrench.force.dot(u) + wrench.torque.dot(blocks[1].omega - blocks[0].omega);
    CHECK(power == doctest::Approx(work).epsilon(1e-12));
  }
}

TEST_CASE("joints that share a load take the least forces that push bodies alike") {
  Random random(11);
  int shared = 0;
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    const Ring w(random, 3 + uint32_t(trial) % 6);
    std::vector<uint32_t> slots(w.bodies.size()), which(w.joints.size());
    std::iota(slots.begin(), slots.end(), 0u);
    std::iota(which.begin(), which.end(), 0u);
    Articulation joints({w.joints}, {which}, slots, w.bodies, w.bodies.size());
    const std::vector<DofBlock> blocks = blocks_of(w.bodies, slots);
    joints.update(w.bodies, blocks);
    shared += joints.dependent_rows() > 0 ? 1 : 0;
    std::vector<double> given(joints.size());
    for (double& f : given) f = random.uniform(-10, 10);
    std::vector<double> least = given;
    take_least_forces(joints, blocks, arm, least);
    Eigen::VectorXd sizes;
    const Eigen::MatrixXd pushes = pushes_of(joints, blocks.size(), sizes);
    const Eigen::VectorXd start =
        sizes.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(given.data(), sizes.size()));
    const Eigen::VectorXd found =
        sizes.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(least.data(), sizes.size()));
    const Eigen::VectorXd want = least_norm(pushes, pushes * start, 1e-9).x;
    CHECK((found - want).norm() < 1e-8 * want.norm());
    CHECK((pushes * (found - start)).norm() < 1e-9 * start.norm());
  }
  CHECK(shared == 40);
}
