#include "engine/dynamics/joints/hold_joints.hpp"

#include "engine/dynamics/contact/exact/projection.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Changes the rows' velocities by what `wanted(row)` says.
template <class Wanted>
void change_rows(std::span<const JointRow> rows, std::span<DofBlock> blocks, const Wanted& wanted) {
  if (rows.empty()) return;
  std::vector<Row> plain;
  Eigen::VectorXd change(Eigen::Index(rows.size()));
  for (size_t i = 0; i < rows.size(); ++i) {
    plain.push_back(rows[i].row);
    change[Eigen::Index(i)] = wanted(rows[i]);
  }
  change_least(plain, change, blocks);
}

double greatest_error(std::span<const JointRow> rows) {
  double worst = 0;
  for (const JointRow& r : rows) worst = std::max(worst, std::fabs(r.error));
  return worst;
}

}  // namespace

void joint_equations(std::span<const Joint> joints, std::span<const RigidBody> bodies,
                     std::span<const uint32_t> block_of, std::vector<JointRow>& rows) {
  rows.clear();
  JointRows own;
  for (const Joint& joint : joints) {
    JointSides sides = joint_sides(joint, bodies);
    sides.a.block = joint.a == no_body ? no_block : block_of[joint.a];
    sides.b.block = joint.b == no_body ? no_block : block_of[joint.b];
    own.clear();
    joint_rows(joint.kind, sides, own);
    rows.insert(rows.end(), own.all().begin(), own.all().end());
  }
}

void hold_accelerations(std::span<const JointRow> rows, std::span<DofBlock> accelerations) {
  change_rows(rows, accelerations,
              [&](const JointRow& r) { return -(row_velocity(r.row, accelerations) + r.bias); });
}

void hold_velocities(std::span<const JointRow> rows, std::span<DofBlock> velocities) {
  change_rows(rows, velocities,
              [&](const JointRow& r) { return -row_velocity(r.row, velocities); });
}

double hold_positions(std::span<const Joint> joints, std::span<RigidBody> bodies,
                      std::span<const uint32_t> slots, std::span<const uint32_t> block_of,
                      double tolerance) {
  std::vector<JointRow> rows;
  joint_equations(joints, bodies, block_of, rows);
  for (int k = 0; k < 8 && greatest_error(rows) > tolerance; ++k) {
    std::vector<DofBlock> blocks(slots.size());
    for (size_t i = 0; i < slots.size(); ++i) {
      const RigidBody& b = bodies[slots[i]];
      if (!b.dynamic()) continue;
      blocks[i].inverse_mass = b.inverse_mass;
      blocks[i].inverse_inertia = b.inverse_inertia_world();
    }
    change_rows(rows, blocks, [](const JointRow& r) { return -r.error; });
    for (size_t i = 0; i < slots.size(); ++i) {
      RigidBody& b = bodies[slots[i]];
      if (!b.dynamic()) continue;
      b.pose.x += blocks[i].v;
      b.pose.q = integrate_rotation(b.pose.q, blocks[i].omega, 1);
    }
    joint_equations(joints, bodies, block_of, rows);
  }
  return greatest_error(rows);
}

}  // namespace tumble
