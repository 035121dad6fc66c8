// Equations of joints: trees of every kind of joint and drive, folded; hubs with many arms; loops
// with redundant rows, in sparse blocks. Reference:
// the same equations as dense matrices, solved by Eigen's complete orthogonal decomposition, and
// the mobility of the mechanisms (Bennett 1903, Bricard 1897).
#include "engine/core/random.hpp"
#include "engine/dynamics/event/impulses/point_mobility.hpp"
#include "engine/dynamics/rows/delassus.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/support/dense.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

using namespace tumble;
using namespace tumble::test;

namespace {

BodyDef lump(Random& r, const Vec3& x) {
  BodyDef d;
  d.pose.x = x;
  d.pose.q = Quat(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), 2).normalized();
  d.mass = r.uniform(0.2, 5);
  d.inertia = *d.mass * Vec3(r.uniform(0.02, 0.03), r.uniform(0.02, 0.03), r.uniform(0.02, 0.03));
  d.velocity = Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  d.angular_velocity = Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  return d;
}

/// Bodies in joints, as an Articulation and as dense matrices.
struct Jointed : BodyList {
  std::vector<Joint> joints;
  Articulation held;
  std::vector<DofBlock> blocks;
  Eigen::MatrixXd G, inverse_mass;

  void join(JointKind kind, uint32_t a, uint32_t b, const Pose& at) {
    joints.push_back(joint_at(kind, bodies, a, b, at));
  }
  void finish() {
    std::vector<uint32_t> slots(bodies.size()), which(joints.size());
    std::iota(slots.begin(), slots.end(), 0u);
    std::iota(which.begin(), which.end(), 0u);
    held = Articulation({joints}, {which}, slots, bodies, bodies.size());
    blocks = blocks_of(bodies, slots);
    held.update(bodies, blocks);
    std::vector<Row> rows;
    for (const JointRow& r : held.rows()) rows.push_back(r.row);
    G = matrix(rows);
    const auto n = Eigen::Index(6 * blocks.size());
    inverse_mass = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index i = 0; i < n / 6; ++i) {
      inverse_mass.block<3, 3>(6 * i, 6 * i) =
          blocks[size_t(i)].inverse_mass * Eigen::Matrix3d::Identity();
      inverse_mass.block<3, 3>(6 * i + 3, 6 * i + 3) = dense(blocks[size_t(i)].inverse_inertia);
    }
  }
  Eigen::MatrixXd matrix(std::span<const Row> rows) const {
    Eigen::MatrixXd out =
        Eigen::MatrixXd::Zero(Eigen::Index(rows.size()), Eigen::Index(6 * blocks.size()));
    for (size_t r = 0; r < rows.size(); ++r)
      for (const RowSide* s : {&rows[r].a, &rows[r].b})
        if (s->block != no_block) {
          const auto at = Eigen::Index(6 * s->block);
          out.block<1, 3>(Eigen::Index(r), at) += dense(s->linear).transpose();
          out.block<1, 3>(Eigen::Index(r), at + 3) += dense(s->angular).transpose();
        }
    return out;
  }
  static Eigen::VectorXd vector(std::span<const DofBlock> blocks) {
    Eigen::VectorXd out(6 * Eigen::Index(blocks.size()));
    for (size_t i = 0; i < blocks.size(); ++i) {
      out.segment<3>(6 * Eigen::Index(i)) = dense(blocks[i].v);
      out.segment<3>(6 * Eigen::Index(i) + 3) = dense(blocks[i].omega);
    }
    return out;
  }
  /// M^-1 G^T (G M^-1 G^T)^+ G, and its rank.
  Eigen::MatrixXd taken(Eigen::Index& rank) const {
    const LeastNorm least = least_norm(product(G, inverse_mass, G.transpose()), G, 1e-10);
    rank = least.rank;
    return product(inverse_mass, G.transpose(), least.x);
  }
  /// Holds the blocks' velocities both ways, and reduces the Delassus matrix of some rows.
  void compare(Random& r) const {
    Eigen::Index rank = 0;
    const Eigen::MatrixXd change = taken(rank);
    CHECK(Eigen::Index(held.dependent_rows()) == G.rows() - rank);
    size_t depending = 0;
    for (size_t i = 0; i < held.size(); ++i) depending += held.depends(i) ? 1 : 0;
    CHECK(depending == held.dependent_rows());
    std::vector<DofBlock> moving = blocks;
    std::vector<double> pushes(held.size());
    held.hold_velocities(moving, pushes);
    const Eigen::VectorXd before = vector(blocks), want = before - change * before;
    CHECK((vector(moving) - want).norm() < 1e-9 * before.norm());
    CHECK((G * vector(moving)).norm() < 1e-11 * before.norm());

    std::vector<Row> rows;
    for (int k = 0; k < 6; ++k) {
      const Vec3 arm(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
      const auto a = r.below(uint32_t(blocks.size())), b = r.below(uint32_t(blocks.size()));
      rows.push_back(point_row(k % 2 ? no_block : a, arm, b, -arm, Vec3::Unit(k % 3)));
    }
    Eigen::MatrixXd got = delassus(rows, blocks);
    held.reduce(rows, got);
    const Eigen::MatrixXd J = matrix(rows), W = inverse_mass - change * inverse_mass;
    const Eigen::MatrixXd reduced = J * W * J.transpose();
    // Rows that joints lock keep their entry.
    for (Eigen::Index i = 0; i < reduced.rows(); ++i)
      for (Eigen::Index k = 0; k < reduced.cols(); ++k)
        if (reduced(i, i) > 1e-9 && reduced(k, k) > 1e-9)
          CHECK(std::fabs(got(i, k) - reduced(i, k)) < 1e-9 * reduced.diagonal().maxCoeff());
    compare_points(r);
  }
  /// What points answer to each other, against the matrices of all their rows.
  void compare_points(Random& r) const {
    std::vector<Row> rows;
    std::vector<Eigen::Index> all;
    for (int point = 0; point < 5; ++point) {
      const Vec3 arm(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
      const auto a = r.below(uint32_t(blocks.size())), b = r.below(uint32_t(blocks.size()));
      for (int k = 0; k < 3; ++k) {
        all.push_back(Eigen::Index(rows.size()));
        rows.push_back(point_row(point % 2 ? no_block : a, arm, b, -arm, Vec3::Unit(k)));
      }
    }
    Eigen::MatrixXd A = delassus(rows, blocks);
    CHECK(PointMobility(rows, blocks, {}).dense(all) == A);
    held.reduce(rows, A);
    const PointMobility mobility(rows, blocks, held);
    CHECK((mobility.dense(all) - A).norm() <= 1e-13 * A.norm());
    Eigen::VectorXd z(A.rows()), y = Eigen::VectorXd::Zero(A.rows());
    for (Eigen::Index i = 0; i < z.size(); ++i) z[i] = r.uniform(-1, 1);
    mobility.add_product(z, y);
    CHECK((y - A * z).norm() <= 1e-13 * A.norm() * z.norm());
  }
};

Quat random_turn(Random& r) {
  return Quat(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(0.1, 1)).normalized();
}

/// The frame whose z axis is `axis`.
Pose hinge(const Vec3& x, const Vec3& axis) {
  return {x, rotation_between(Vec3::UnitZ(), axis.normalized())};
}

}  // namespace

TEST_CASE("hubs that carry many arms are held like dense equations say") {
  Random r(31);
  for (int trial = 0; trial < 24; ++trial) {
    CAPTURE(trial);
    Jointed w;
    const uint32_t hubs = 1 + uint32_t(trial % 3), arms = 2 + uint32_t(r.below(6));
    for (uint32_t h = 0; h < hubs; ++h) w.add(lump(r, {3.0 * h, 0, 0}));
    for (uint32_t h = 0; h + 1 < hubs; ++h) {
      if (trial % 4 < 2) {
        w.join(trial % 2 ? JointKind::revolute : JointKind::universal, h, h + 1,
               {Vec3(3.0 * h + 1.5, 0, 0), random_turn(r)});
        continue;
      }
      const uint32_t link = w.add(lump(r, {3.0 * h + 1.5, 0, 0}));
      w.join(JointKind::revolute, h, link, {Vec3(3.0 * h + 1, 0, 0), random_turn(r)});
      w.join(JointKind::revolute, link, h + 1, {Vec3(3.0 * h + 2, 0, 0), random_turn(r)});
    }
    if (trial % 4 == 0) w.join(JointKind::spherical, no_body, 0, {Vec3(0, 1, 0), random_turn(r)});
    for (uint32_t h = 0; h < hubs; ++h)
      for (uint32_t k = 0; k < arms; ++k) {
        const double angle = 6.28 * k / arms;
        const Vec3 out(0, std::cos(angle), std::sin(angle)), x = w.bodies[h].pose.x;
        const uint32_t first = w.add(lump(r, x + out)), second = w.add(lump(r, x + 2 * out));
        w.join(k % 2 ? JointKind::revolute : JointKind::prismatic, h, first,
               {x + 0.5 * out, random_turn(r)});
        w.join(JointKind::spherical, first, second, {x + 1.5 * out, random_turn(r)});
      }
    // A loop through two hubs.
    if (trial % 6 == 2)
      w.join(JointKind::spherical, 1, uint32_t(w.bodies.size() - 1),
             {Vec3(4, 2, 1), random_turn(r)});
    w.finish();
    w.compare(r);
  }
}

TEST_CASE(
    "trees of all kinds of joints, with rotors and motors, are held like dense equations say") {
  Random r(35);
  const auto random_vector = [&r] {
    return Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  };
  for (int trial = 0; trial < 40; ++trial) {
    CAPTURE(trial);
    Jointed w;
    const uint32_t bodies = 2 + uint32_t(r.below(12));
    for (uint32_t i = 0; i < bodies; ++i) {
      w.add(lump(r, random_vector()));
      // A tree from the world, or one that floats; bodies that never turn are not folded, and make
      // rows depend on others.
      const bool some_stiff = trial % 5 == 4;
      if (some_stiff && i % 4 == 3) {
        w.bodies[i].inverse_inertia_body.setZero();
        w.bodies[i].omega.setZero();
      }
      const auto before = i == 0 ? no_body : uint32_t(r.below(i));
      if (i == 0 && trial % 2) continue;
      const auto kind = JointKind(r.below(uint32_t(all_joint_kinds().size())));
      const bool turned = i > 0 && r.below(2);
      w.join(kind, turned ? i : before, turned ? before : i, {random_vector(), random_turn(r)});
      // Somewhat open.
      Joint& joint = w.joints.back();
      joint.frame_b.x += 0.1 * random_vector();
      joint.frame_b.q = (joint.frame_b.q * Quat(1, 0.1, 0.05, 0.08)).normalized();
      if (some_stiff || trial % 3 == 0) continue;
      JointDrives drives;
      for (size_t k = 0; k < entry_of(kind).coordinates.size(); ++k) {
        if (r.below(2)) drives[k].armature = r.uniform(0.05, 2);
        if (r.below(3)) continue;
        drives[k].motor.kind = MotorKind::velocity;
        drives[k].motor.target = r.uniform(-1, 1);
      }
      joint.drives = std::make_shared<JointDrives>(drives);
    }
    if (w.joints.empty()) continue;
    w.finish();
    const auto n = Eigen::Index(w.held.size());
    Eigen::MatrixXd A = product(w.G, w.inverse_mass, w.G.transpose());
    Eigen::VectorXd change = -w.G * Jointed::vector(w.blocks);
    for (Eigen::Index i = 0; i < n; ++i) {
      A(i, i) += w.held.held()[size_t(i)].give;
      change[i] += w.held.held()[size_t(i)].rate;
    }
    const auto [solution, rank] = least_norm(A, change, 1e-10);
    CHECK(Eigen::Index(w.held.dependent_rows()) == n - rank);
    const Eigen::VectorXd want = solution;
    std::vector<DofBlock> moving = w.blocks;
    std::vector<double> got(w.held.size());
    w.held.hold_velocities(moving, got);
    if (rank == n)
      CHECK((Eigen::Map<Eigen::VectorXd>(got.data(), n) - want).norm() < 1e-10 * want.norm());
    const Eigen::VectorXd moved = Jointed::vector(moving) - Jointed::vector(w.blocks);
    CHECK((moved - w.inverse_mass * w.G.transpose() * want).norm() < 1e-10 * (1 + moved.norm()));
  }
}

TEST_CASE("redundant joints: as many rows depend on others as mobility says") {
  Random r(32);
  SUBCASE("a door on three hinges") {
    Jointed w;
    w.add(lump(r, {0.4, 1, 0}));
    for (const double y : {0.2, 1.0, 1.8})
      w.join(JointKind::revolute, no_body, 0, hinge({0, y, 0}, Vec3::UnitY()));
    w.finish();
    CHECK(w.held.dependent_rows() == 10);
    for (size_t i = 0; i < 5; ++i) CHECK_FALSE(w.held.depends(i));
    w.compare(r);
  }
  SUBCASE("Bricard's, of rods along the edges of a cube, has one freedom with 30 rows") {
    Jointed w;
    const std::array<Vec3, 6> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                      Vec3(1, 1, 1), Vec3(0, 1, 1), Vec3(0, 0, 1)};
    for (size_t i = 0; i < 5; ++i) w.add(lump(r, 0.5 * (corners[i] + corners[i + 1])));
    for (size_t i = 0; i < 5; ++i)
      w.join(JointKind::revolute, i == 0 ? no_body : uint32_t(i - 1), uint32_t(i),
             hinge(corners[i], Vec3::Unit((int(i) + 1) % 3)));
    w.join(JointKind::revolute, no_body, 4, hinge(corners[5], Vec3::UnitX()));
    w.finish();
    CHECK(w.held.size() == 30);
    CHECK(w.held.dependent_rows() == 1);
    w.compare(r);
  }
  SUBCASE("Bennett's, of four hinges askew, has one freedom with 20 rows") {
    // Lengths a, b and twists alpha, beta with a / sin alpha = b / sin beta; of the angles,
    // tan(t1/2) tan(t2/2) = sin((beta + alpha)/2) / sin((beta - alpha)/2).
    const double alpha = 0.5, beta = 1.3, a = std::sin(alpha), b = std::sin(beta), t1 = 1.1;
    const double t2 = 2 * std::atan(std::sin(0.5 * (beta + alpha)) /
                                    (std::sin(0.5 * (beta - alpha)) * std::tan(0.5 * t1)));
    const std::array<double, 4> turn{t1, t2, -t1, -t2}, length{a, b, a, b},
        twist{alpha, beta, alpha, beta};
    std::array<Pose, 5> frames;
    for (size_t i = 0; i < 4; ++i) {
      const Quat turned = frames[i].q * axis_angle(Vec3::UnitZ(), turn[i]);
      frames[i + 1].x = frames[i].x + turned * Vec3(length[i], 0, 0);
      frames[i + 1].q = turned * axis_angle(Vec3::UnitX(), twist[i]);
    }
    REQUIRE((frames[4].x - frames[0].x).norm() < 1e-12);
    Jointed w;
    for (size_t i = 0; i < 3; ++i) w.add(lump(r, 0.5 * (frames[i].x + frames[i + 1].x)));
    for (size_t i = 0; i < 3; ++i)
      w.join(JointKind::revolute, i == 0 ? no_body : uint32_t(i - 1), uint32_t(i), frames[i]);
    w.join(JointKind::revolute, no_body, 2, frames[3]);
    w.finish();
    CHECK(w.held.dependent_rows() == 3);
    w.compare(r);
  }
}

TEST_CASE("rows between bodies that nothing moves depend, all of them") {
  Random r(36);
  Jointed w;
  for (int i = 0; i < 2; ++i) {
    BodyDef d = lump(r, {double(i), 0, 0});
    d.type = BodyType::kinematic;
    w.add(d);
  }
  w.join(JointKind::revolute, 0, 1, {Vec3(0.5, 0, 0), random_turn(r)});
  w.finish();
  CHECK(w.held.dependent_rows() == 5);
  for (size_t i = 0; i < 5; ++i) CHECK(w.held.depends(i));
  // With others beside them.
  w.add(lump(r, {2, 0, 0}));
  w.join(JointKind::spherical, 1, 2, {Vec3(1.5, 0, 0), random_turn(r)});
  w.finish();
  CHECK(w.held.dependent_rows() == 5);
}

TEST_CASE("hinges that share a door's weight bear the same, in the mean of a tick too") {
  EventWorld w(240);
  BodyDef door = body(box(0.4, 1, 0.02), {0.4, 1, 0});
  door.mass = 30;
  w.add(door);
  for (const double y : {0.2, 1.8})
    w.join(JointKind::revolute, no_body, 0,
           {{0, y, 0}, rotation_between(Vec3::UnitZ(), Vec3::UnitY())});
  w.run(0.1);
  for (const Joint& j : w.joints)
    CHECK(j.moving_force[1] == doctest::Approx(30 * 9.81 / 2).epsilon(1e-9));
}

TEST_CASE("many contacts move jointed bodies alike with the joints among the unknowns or not") {
  // A row of boxes in hinges on a smooth floor, pulled this way and that: some lift a corner. With
  // friction there would be more than one answer.
  constexpr uint32_t boxes = 18;
  Random r(33);
  for (int trial = 0; trial < 6; ++trial) {
    CAPTURE(trial);
    Jointed w;
    for (uint32_t i = 0; i < boxes; ++i) {
      w.add(body(box(0.5, 0.5, 0.5), {double(i), 0.5, 0}));
      if (i > 0)
        w.join(i % 2 ? JointKind::revolute : JointKind::spherical, i - 1, i,
               hinge({i - 0.5, 0.5, 0}, Vec3::UnitZ()));
    }
    w.finish();
    REQUIRE(w.held.plain());
    std::vector<DofBlock> free = w.blocks;
    for (DofBlock& b : free) {
      b.v = Vec3(r.uniform(-20, 30), -9.81, r.uniform(-20, 30));
      b.omega = Vec3(r.uniform(-60, 60), r.uniform(-9, 9), r.uniform(-60, 60));
    }
    std::vector<double> forces(w.held.size());
    w.held.hold_accelerations(free, forces);
    std::vector<ForcePoint> points;
    for (uint32_t i = 0; i < boxes; ++i)
      for (const double x : {-0.5, 0.5})
        for (const double z : {-0.5, 0.5}) {
          ForcePoint& p = points.emplace_back();
          p.b = i;
          p.arm_b = {x, -0.5, z};
        }
    const auto moved = [&](bool least) {
      ContactForceMethod method;
      method.least = least;
      std::vector<DofBlock> moving = free;
      std::vector<Vec3> at_points;
      std::vector<double> pushes(w.held.size());
      CHECK(solve_contact_forces(moving, points, method, at_points, w.held).solved);
      w.held.hold_accelerations(moving, pushes);
      return Jointed::vector(moving);
    };
    const Eigen::VectorXd among = moved(false), eliminated = moved(true);
    CHECK(eliminated.norm() > 1);
    CHECK((among - Jointed::vector(free)).norm() > 1);
    CHECK((among - eliminated).norm() < 1e-6 * eliminated.norm());
  }
}
