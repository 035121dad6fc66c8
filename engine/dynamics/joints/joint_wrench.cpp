#include "engine/dynamics/joints/joint_wrench.hpp"

#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace tumble {
namespace {

constexpr uint32_t body_freedoms = 6;

/// The rows as a matrix G from displacements of bodies to rows, all in metres. Joints of equal
/// stiffness have the forces G times displacements.
class ScaledRows {
 public:
  ScaledRows(const Articulation& joints, std::span<const DofBlock> blocks, double arm)
      : joints_(joints), blocks_(blocks), arm_(arm) {}

  /// The places of G^T G, which stay the same as long as the joints tie the same blocks.
  BlockLdl layout() const {
    const Articulation& joints = joints_;
    std::vector<std::pair<uint32_t, uint32_t>> coupled;
    for (size_t j = 0; j < joints.joints(); ++j) {
      if (joints.first_row(j) == joints.first_row(j + 1)) continue;
      add_pairs(joints.first_row(j), coupled);
    }
    for (size_t r = joints.first_row(joints.joints()); r < joints.size(); ++r)
      add_pairs(r, coupled);
    return BlockLdl(std::vector<uint32_t>(blocks_.size(), body_freedoms), coupled);
  }
  /// Factors G^T G.
  void factor(BlockLdl& normal) const {
    normal.clear();
    for (size_t r = 0; r < joints_.size(); ++r) add_row(r, normal);
    normal.factor();
  }

  /// Force by row in newtons per force in the row's own unit.
  double unit(size_t row) const { return turns(row) ? 1 / arm_ : 1; }
  size_t freedoms() const { return body_freedoms * blocks_.size(); }
  /// out += sign G^T forces.
  void add_pushes(std::span<const double> forces, double sign, std::span<double> out) const {
    for (size_t r = 0; r < forces.size(); ++r)
      for_ends(r, [&](uint32_t block, const std::array<double, body_freedoms>& g) {
        for (size_t k = 0; k < body_freedoms; ++k)
          out[body_freedoms * block + k] += sign * forces[r] * g[k];
      });
  }
  /// forces += G (G^T G)^+ pushes, with the factor of G^T G; pushes become displacements.
  void add_forces(const BlockLdl& normal, std::span<double> pushes,
                  std::span<double> forces) const {
    normal.solve(pushes);
    for (size_t r = 0; r < forces.size(); ++r)
      for_ends(r, [&](uint32_t block, const std::array<double, body_freedoms>& g) {
        for (size_t k = 0; k < body_freedoms; ++k)
          forces[r] += g[k] * pushes[body_freedoms * block + k];
      });
  }

 private:
  bool moves(const RowSide& side) const { return blocks_[side.block].inverse_mass > 0; }
  bool turns(size_t row) const { return joints_.rows()[row].row.b.linear.isZero(0); }

  template <class F>
  void for_ends(size_t row, const F& f) const {
    const double scale = turns(row) ? arm_ : 1;
    joints_.for_sides(row, [&](const RowSide& s) {
      if (!moves(s)) return;
      const Vec3 linear = scale * s.linear, angular = scale / arm_ * s.angular;
      f(s.block,
        std::array{linear.x(), linear.y(), linear.z(), angular.x(), angular.y(), angular.z()});
    });
  }
  void add_pairs(size_t row, std::vector<std::pair<uint32_t, uint32_t>>& out) const {
    for_ends(row, [&](uint32_t p, const auto&) {
      for_ends(row, [&](uint32_t q, const auto&) {
        if (p < q) out.emplace_back(p, q);
      });
    });
  }

  void add_row(size_t row, BlockLdl& normal) const {
    std::array<std::pair<uint32_t, std::array<double, body_freedoms>>, 4> ends;
    size_t count = 0;
    for_ends(row, [&](uint32_t block, const auto& g) {
      const auto known = std::find_if(ends.begin(), ends.begin() + count,
                                      [&](const auto& end) { return end.first == block; });
      if (known == ends.begin() + count)
        ends[count++] = {block, g};
      else
        for (size_t k = 0; k < body_freedoms; ++k) known->second[k] += g[k];
    });
    for (size_t p = 0; p < count; ++p)
      for (size_t q = 0; q <= p; ++q)
        for (uint32_t i = 0; i < body_freedoms; ++i)
          for (uint32_t k = 0; k < body_freedoms; ++k)
            normal.add(ends[p].first, i, ends[q].first, k, ends[p].second[i] * ends[q].second[k]);
  }

  const Articulation& joints_;
  std::span<const DofBlock> blocks_;
  double arm_;
};

double greatest(std::span<const double> values) {
  double most = 0;
  for (const double v : values) most = std::max(most, std::fabs(v));
  return most;
}

}  // namespace

JointWrench joint_wrench(std::span<const JointRow> rows, std::span<const double> forces,
                         const Vec3& arm_b) {
  JointWrench out;
  for (size_t i = 0; i < rows.size(); ++i) {
    out.force += forces[i] * rows[i].row.b.linear;
    out.torque += forces[i] * rows[i].row.b.angular;
  }
  out.torque -= arm_b.cross(out.force);
  return out;
}

void add_coordinate_wrench(const Joint& joint, size_t coordinate, double force,
                           std::span<const RigidBody> bodies, JointWrench& out) {
  const JointSides sides = sides_with_axes(joint, bodies);
  const JointRow row = entry_of(joint.kind).coordinates[coordinate].row(sides);
  const JointWrench more = joint_wrench({&row, 1}, {&force, 1}, sides.b.arm);
  out.force += more.force;
  out.torque += more.torque;
}

JointWrench wrench_of_rows(const Joint& joint, const JointSides& sides) {
  JointRows rows;
  joint_rows(joint.kind, sides, rows);
  if (joint.drives)
    for (const JointCoordinate& c : entry_of(joint.kind).coordinates) rows.push_back(c.row(sides));
  std::array<double, JointRows::most> forces{};
  for (size_t i = 0; i < rows.size(); ++i)
    forces[i] = joint.moving_force[i] + joint.relaxing_force[i];
  return joint_wrench(rows.all(), forces, sides.b.arm);
}

double typical_arm(std::span<const RigidBody> bodies, std::span<const uint32_t> slots) {
  double mass = 0, second_moment = 0;
  for (const uint32_t slot : slots) {
    if (!bodies[slot].dynamic()) continue;
    mass += bodies[slot].mass;
    second_moment += 0.5 * bodies[slot].inertia_body.trace();
  }
  return second_moment > 0 ? std::sqrt(second_moment / mass) : 1;
}

void take_least_forces(const Articulation& joints, std::span<const DofBlock> blocks, double arm,
                       std::span<double> forces) {
  if (joints.dependent_rows() > 0) LeastForces().spread(joints, blocks, arm, forces);
}

void LeastForces::spread(const Articulation& joints, std::span<const DofBlock> blocks, double arm,
                         std::span<double> forces) {
  const ScaledRows rows(joints, blocks, arm);
  if (normal_.size() == 0) normal_ = rows.layout();
  rows.factor(normal_);
  given_.resize(forces.size());
  for (size_t r = 0; r < given_.size(); ++r) given_[r] = rows.unit(r) * forces[r];
  const double size = greatest(given_);
  least_.assign(forces.size(), 0.0);
  left_.assign(rows.freedoms(), 0.0);
  rows.add_pushes(given_, 1, left_);
  for (int pass = 0; pass < tolerances::most_reaction_passes &&
                     greatest(left_) > tolerances::reaction_rounding * size;
       ++pass) {
    rows.add_forces(normal_, left_, least_);
    std::ranges::fill(left_, 0.0);
    rows.add_pushes(given_, 1, left_);
    rows.add_pushes(least_, -1, left_);
  }
  if (greatest(left_) > tolerances::reaction_left * size) return;
  for (size_t r = 0; r < forces.size(); ++r) forces[r] = least_[r] / rows.unit(r);
}

}  // namespace tumble
