// Joints in the inner loops of the realtime solver.
#include "engine/dynamics/realtime/solve_joints.hpp"

#include "engine/dynamics/realtime/blows.hpp"
#include "engine/dynamics/realtime/joint_lines.hpp"
#include "engine/dynamics/realtime/kept_rows.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {

JointSide side_now(const SolverContext& c, const SolverIsland& island, uint32_t slot,
                   uint32_t local, const Pose& frame, bool uses_axes) {
  JointSide s;
  if (slot == no_body) {
    s.arm = frame.x;
    s.q = frame.q;
    if (uses_axes) s.axes = s.q.toRotationMatrix();
    return s;
  }
  const SolverBody& body = island.bodies[local];
  const Quat q = island.motions[local].dq * c.bodies[slot].pose.q;
  s.x = c.bodies[slot].pose.x + body.dx;
  s.v = body.v;
  s.omega = body.w;
  s.arm = q * frame.x;
  if (!uses_axes) return s;
  s.q = q * frame.q;
  s.axes = s.q.toRotationMatrix();
  return s;
}

namespace {

using Values = JointBlock::Values;

/// Access to the entries of a joint's factor.
auto entries(JointBlock& joint) {
  return [&joint](uint32_t i, uint32_t j) -> double& { return joint.factor[i][j]; };
}

void set_effective_mass(const SolverBody& a, const SolverBody& b, JointBlock& joint) {
  const double inverse_mass = a.inverse_mass + b.inverse_mass;
  for (uint32_t i = 0; i < joint.count; ++i) {
    const JointBlock::Line& row = joint.lines[i];
    const Vec3 l = inverse_mass * row.linear;
    const Vec3 wa = a.inverse_inertia * row.angular_a, wb = b.inverse_inertia * row.angular_b;
    for (uint32_t k = 0; k <= i; ++k) {
      const JointBlock::Line& other = joint.lines[k];
      joint.factor[i][k] = l.dot(other.linear) + wa.dot(other.angular_a) + wb.dot(other.angular_b);
    }
  }
  Values scaled;
  factorise_kept(entries(joint), joint.kept, joint.count, scaled);
}

/// Sets the compliances of coordinates from the factor.
void set_compliances(const SolverIsland& island, const JointBlock& joint) {
  for (uint32_t i = joint.kept; i < joint.count; ++i)
    drives_of(island, joint)[i - joint.kept].mass = joint.factor[i][i];
}

/// Impulse and moments on both bodies of impulses impulse(row).
template <class F>
JointPush push_of(const JointBlock& joint, const F& impulse) {
  JointPush push;
  for (uint32_t i = 0; i < joint.count; ++i) {
    const JointBlock::Line& row = joint.lines[i];
    const double of_row = impulse(i);
    push.impulse += of_row * row.linear;
    push.moment_a += of_row * row.angular_a;
    push.moment_b += of_row * row.angular_b;
  }
  return push;
}
JointPush push_of(const JointBlock& joint, const Values& impulse) {
  return push_of(joint, [&impulse](uint32_t i) { return impulse[i]; });
}

void push_joint(const SolverIsland& island, const JointBlock& joint, const JointPush& push) {
  SolverBody& a = island.bodies[joint.a];
  SolverBody& b = island.bodies[joint.b];
  a.v -= a.inverse_mass * push.impulse;
  a.w += a.inverse_inertia * push.moment_a;
  b.v += b.inverse_mass * push.impulse;
  b.w += b.inverse_inertia * push.moment_b;
}

void solve_joint(const SolverIsland& island, double hs, JointPass pass, JointBlock& joint) {
  const SolverBody& a = island.bodies[joint.a];
  const SolverBody& b = island.bodies[joint.b];
  Values change;
  for (uint32_t i = joint.kept; i < joint.count; ++i)
    change[i] = line_velocity(a, b, joint.lines[i]);
  for (uint32_t i = 0; i < joint.kept; ++i) {
    const JointBlock::Line& row = joint.lines[i];
    change[i] = kept_velocity(line_velocity(a, b, row), row.error, row.bias, hs,
                              island.joint_softness, pass);
  }
  eliminate_kept(entries(joint), joint.kept, joint.count, change);
  if (joint.count > joint.kept) {
    Values of_laws;
    DriveRow* const first = &island.drives[joint.first_drive] - joint.kept;
    if (pass == JointPass::correcting)
      leave_of_soft(
          entries(joint), joint.kept, joint.count, island.joint_softness.impulse_scale,
          [&joint, pass](uint32_t i) { return joint.total(i, pass); }, change);
    solve_laws(
        entries(joint), joint.kept, joint.count,
        [first](uint32_t i, double free) { return first[i].solve(free); },
        [&joint, pass](uint32_t i) { return joint.impulse(i, pass); }, of_laws, change);
  }
  substitute_kept(entries(joint), joint.kept, joint.count, change);
  for (uint32_t i = 0; i < joint.count; ++i) {
    change[i] = i < joint.kept
                    ? kept_change(change[i], joint.total(i, pass), island.joint_softness, pass)
                    : -change[i];
    joint.impulse(i, pass) += change[i];
  }
  push_joint(island, joint, push_of(joint, change));
}

/// Sets the compliances of coordinates for the passes before the bodies move, in which joints are
/// soft.
void soften_joints(const SolverIsland& island) {
  const double give = island.joint_softness.impulse_scale;
  if (give == 0 || island.drives.empty()) return;
  for (JointBlock& joint : island.joints) {
    if (joint.coupled) continue;
    soften_kept(entries(joint), joint.kept, joint.count, give);
    set_compliances(island, joint);
  }
  soften_couplings(island, give);
}

/// Sets up the force laws of a pass, before any of its impulses.
void start_drives(const SolverIsland& island, double hs, JointPass pass) {
  if (island.drives.empty()) return;
  for (JointBlock& joint : island.joints) {
    const std::span<DriveRow> drives = drives_of(island, joint);
    for (uint32_t k = 0; k < drives.size(); ++k) {
      DriveRow& d = drives[k];
      d.before = line_velocity(island.bodies[joint.a], island.bodies[joint.b],
                               joint.lines[joint.kept + k]);
      d.rate = d.v;
      d.set_law(pass, hs);
    }
  }
}

/// Computes the rows of coordinates at the present poses and velocities.
void refresh_drives(const SolverIsland& island, double hs, const JointKindEntry& kind,
                    const JointSides& sides, JointBlock& joint) {
  const double turned = (sides.b.omega - sides.a.omega).norm() * hs;
  const double moved = (sides.b.anchor_velocity() - sides.a.anchor_velocity()).norm() * hs;
  for (DriveRow& d : drives_of(island, joint)) {
    const JointCoordinate& coordinate = kind.coordinates[d.coordinate];
    const JointRow row = coordinate.row(sides);
    joint.lines[joint.kept + size_t(&d - &island.drives[joint.first_drive])] = {
        row.row.b.linear, row.row.a.angular, row.row.b.angular, row.error, row.bias};
    d.value = coordinate.turns ? nearest_turn(row.error, d.value + hs * d.moved) : row.error;
    // The second-order term is limited to the motion itself, beyond which it predicts nothing.
    const double most = coordinate.angle ? turned : moved;
    d.curve = std::clamp(0.5 * hs * hs * row.bias, -most, most);
  }
}

}  // namespace

void add_drives(const Joint& from, size_t first, JointBlock& joint, std::vector<DriveRow>& drives) {
  joint.kept = uint32_t(row_count(from.kind));
  joint.first_drive = uint32_t(drives.size() - first);
  for (uint32_t k = 0; k < most_coordinates; ++k) {
    if (!from.driven(k)) continue;
    DriveRow& d = drives.emplace_back();
    d.drive = &(*from.drives)[k];
    d.coordinate = k;
  }
  joint.count = joint.kept + uint32_t(drives.size() - first) - joint.first_drive;
}

void sum_joints(const SolverIsland& island, double hs, JointPass pass) {
  for (JointBlock& joint : island.joints) {
    joint.add(push_of(joint, [&](uint32_t i) { return joint.total(i, pass); }));
    for (DriveRow& d : drives_of(island, joint)) {
      d.add_up(pass);
      if (pass == JointPass::moving)
        d.end_moving(hs, island.kick);
      else
        d.end_relaxing(hs);
    }
  }
  sum_couplings(island, hs, pass);
}

Softness joint_softness(double hs) {
  return soft_step(tolerances::joint_frequency_share / hs, tolerances::joint_damping_ratio, hs);
}

void prepare_joints(const SolverContext& c, const SolverIsland& island, double hs) {
  for (JointBlock& joint : island.joints) {
    const Joint& from = c.joints[joint.source];
    joint.sum = {};
    const std::span<const DriveRow> drives = drives_of(island, joint);
    for (size_t i = 0; i < joint.count; ++i) {
      const size_t k = i < joint.kept ? i : joint.kept + drives[i - joint.kept].coordinate;
      joint.moving[i] = hs * from.moving_force[k];
      joint.relaxing[i] = hs * from.relaxing_force[k];
    }
    for (DriveRow& d : drives_of(island, joint)) {
      d.value = from.value[d.coordinate];
      d.t = c.passed;
    }
  }
  prepare_couplings(c, island, hs);
  refresh_joints(c, island, hs);
  for (JointBlock& joint : island.joints)
    for (uint32_t i = joint.kept; i < joint.count; ++i)
      drives_of(island, joint)[i - joint.kept].v =
          line_velocity(island.bodies[joint.a], island.bodies[joint.b], joint.lines[i]);
}

void refresh_joints(const SolverContext& c, const SolverIsland& island, double hs) {
  JointRows rows;
  for (JointBlock& joint : island.joints) {
    const Joint& from = c.joints[joint.source];
    const JointKindEntry& kind = entry_of(from.kind);
    const bool axes = kind.uses_axes || from.drives;
    const JointSides sides{side_now(c, island, from.a, joint.a, from.frame_a, axes),
                           side_now(c, island, from.b, joint.b, from.frame_b, axes), from.length};
    joint.arm_b = sides.b.arm;
    rows.clear();
    joint_rows(from.kind, sides, rows);
    refresh_drives(island, hs, kind, sides, joint);
    const double share = followed_share(island.bodies[joint.a], island.bodies[joint.b], hs);
    for (uint32_t i = 0; i < joint.kept; ++i) {
      const JointRow& r = rows[i];
      joint.lines[i] = {r.row.b.linear, r.row.a.angular, r.row.b.angular, r.error, share * r.bias};
    }
    if (joint.coupled) continue;
    set_effective_mass(island.bodies[joint.a], island.bodies[joint.b], joint);
    set_compliances(island, joint);
  }
  refresh_couplings(c, island, hs);
}

void warm_start_joints(const SolverIsland& island, double hs, JointPass pass) {
  if (pass == JointPass::moving) soften_joints(island);
  start_drives(island, hs, pass);
  for (JointBlock& joint : island.joints) {
    Values& impulse = pass == JointPass::moving ? joint.moving : joint.relaxing;
    if (pass == JointPass::moving) joint.correcting.fill(0);
    const JointPush push = push_of(joint, impulse);
    if (turns_away(island.bodies[joint.a], push.moment_a, hs) ||
        turns_away(island.bodies[joint.b], push.moment_b, hs))
      impulse.fill(0);
    else
      push_joint(island, joint, push);
  }
  warm_start_couplings(island, hs, pass);
}

void sweep_joints(const SolverIsland& island, double hs, JointPass pass, JointSweeps which) {
  for (int k = which.begin; k < which.end; ++k) {
    if (k % 2 == 0) {
      for (JointBlock& joint : island.joints)
        if (!joint.coupled) solve_joint(island, hs, pass, joint);
      for (CoupledJoints& coupled : island.coupled) solve_coupled(island, hs, pass, coupled);
    } else {
      for (size_t i = island.coupled.size(); i-- > 0;)
        solve_coupled(island, hs, pass, island.coupled[i]);
      for (size_t i = island.joints.size(); i-- > 0;)
        if (!island.joints[i].coupled) solve_joint(island, hs, pass, island.joints[i]);
    }
  }
}

namespace {

/// Adds the correcting impulses to those that are warm-started.
void keep_corrections(const SolverIsland& island) {
  for (JointBlock& joint : island.joints)
    for (uint32_t i = 0; i < joint.kept; ++i)
      joint.moving[i] += std::exchange(joint.correcting[i], 0);
  for (CoupledJoints& coupled : island.coupled)
    for (CouplingBlock& c : coupled.couplings) c.moving += std::exchange(c.correcting, 0);
}

}  // namespace

void move_onto_joints(const SolverIsland& island, double hs) {
  const JointSweeps all{0, island.joint_sweeps};
  if (nears_limit(island)) {
    sweep_joints(island, hs, JointPass::correcting, all);
    keep_corrections(island);
    remember_impulses(island);
    put_limits(island, hs);
  }
  sweep_joints(island, hs, JointPass::correcting, all);
  keep_corrections(island);
}

void relax_joints(const SolverIsland& island, double hs) {
  const JointSweeps all{0, island.joint_sweeps};
  sweep_joints(island, hs, JointPass::relaxing, all);
  // The impact spreads through the whole mechanism.
  for (int turn = 1; turn < tolerances::most_bounce_turns; ++turn) {
    if (!(blow_change(island) > tolerances::bounce_error)) return;
    sweep_joints(island, hs, JointPass::relaxing, all);
  }
}

bool has_armature(const SolverIsland& island) {
  return std::ranges::any_of(island.joints, [&island](const JointBlock& joint) {
    return std::ranges::any_of(drives_of(island, joint),
                               [](const DriveRow& d) { return d.drive->armature > 0; });
  });
}

void follow_with_armatures(const SolverIsland& island, double hs) {
  if (island.rows.empty() || !has_armature(island)) return;
  sweep_joints(island, hs, JointPass::relaxing, {0, island.joint_sweeps});
}

double store_joints(const SolverContext& c, const SolverIsland& island, double hs) {
  double residual = store_couplings(c, island, hs);
  for (JointBlock& joint : island.joints) {
    Joint& to = c.joints[joint.source];
    const std::span<const DriveRow> drives = drives_of(island, joint);
    const SolverBody& a = island.bodies[joint.a];
    const SolverBody& b = island.bodies[joint.b];
    for (uint32_t i = 0; i < joint.kept; ++i) {
      to.moving_force[i] = joint.moving[i] / hs;
      to.relaxing_force[i] = joint.relaxing[i] / hs;
      residual = std::max(residual, std::fabs(line_velocity(a, b, joint.lines[i])));
    }
    for (const DriveRow& d : drives) {
      const size_t i = joint.kept + size_t(&d - drives.data()), k = joint.kept + d.coordinate;
      to.moving_force[k] = joint.moving[i] / hs;
      to.relaxing_force[k] = joint.relaxing[i] / hs;
      to.value[d.coordinate] = d.value;
      to.motor_impulse[d.coordinate] += d.motor_impulse;
      joint.sum.motors += d.motor_work;
      joint.sum.friction += d.friction_work;
      joint.sum.limits += d.limit_work;
    }
    if (!c.joint_pushes.empty()) c.joint_pushes[joint.source] = joint.sum;
  }
  return residual;
}

}  // namespace tumble
