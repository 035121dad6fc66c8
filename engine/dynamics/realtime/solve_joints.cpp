// Joints in the inner loops of the realtime solver.
#include "engine/dynamics/realtime/solve_joints.hpp"

#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

using Values = JointBlock::Values;

/// Where a side of a joint is within the tick.
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
  s.arm = q._transformVector(frame.x);
  if (!uses_axes) return s;
  s.q = q * frame.q;
  s.axes = s.q.toRotationMatrix();
  return s;
}

/// L D L^T in place of the lower triangle, of the first `kept` rows; the block of the others
/// becomes what these leave of it. Rows that depend on the ones before get no impulse.
void factorise(std::array<Values, JointBlock::most>& k, uint32_t kept, uint32_t n) {
  Values scaled;
  const auto divide = [&](uint32_t j, uint32_t columns) {
    for (uint32_t m = 0; m < columns; ++m) {
      scaled[m] = k[j][m];  // L D
      k[j][m] *= k[m][m];
    }
  };
  const auto is_left = [](double d, double diagonal) {
    return d > tolerances::dependent_row * diagonal;
  };
  for (uint32_t j = 0; j < kept; ++j) {
    const double diagonal = k[j][j];
    divide(j, j);
    double d = diagonal;
    for (uint32_t m = 0; m < j; ++m) d -= scaled[m] * k[j][m];
    k[j][j] = is_left(d, diagonal) ? 1 / d : 0;
    for (uint32_t i = j + 1; i < n; ++i) {
      for (uint32_t m = 0; m < j; ++m) k[i][j] -= k[i][m] * k[j][m];
    }
  }
  for (uint32_t j = kept; j < n; ++j) {
    const double diagonal = k[j][j];
    divide(j, kept);
    for (uint32_t i = kept; i <= j; ++i)
      for (uint32_t m = 0; m < kept; ++m) k[j][i] -= scaled[m] * k[i][m];
    if (!is_left(k[j][j], diagonal)) k[j][j] = 0;
  }
}

/// x -= L^-1 x: velocities without what the kept rows do about theirs.
void eliminate(const JointBlock& joint, Values& x) {
  for (uint32_t i = 0; i < joint.count; ++i)
    for (uint32_t m = 0; m < std::min(i, joint.kept); ++m) x[i] -= joint.factor[i][m] * x[m];
}

/// From eliminated velocities, and the changes of the other impulses, to those of the kept rows.
void substitute(const JointBlock& joint, Values& x) {
  for (uint32_t i = 0; i < joint.kept; ++i) x[i] *= joint.factor[i][i];
  for (uint32_t i = joint.kept; i-- > 0;)
    for (uint32_t m = i + 1; m < joint.count; ++m) x[i] -= joint.factor[m][i] * x[m];
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
  factorise(joint.factor, joint.kept, joint.count);
}

JointPush push_of(const JointBlock& joint, const Values& impulse) {
  JointPush push;
  for (uint32_t i = 0; i < joint.count; ++i) {
    const JointBlock::Line& row = joint.lines[i];
    push.impulse += impulse[i] * row.linear;
    push.moment_a += impulse[i] * row.angular_a;
    push.moment_b += impulse[i] * row.angular_b;
  }
  return push;
}

/// What is taken into account of how the lines of a joint bend within a sub-step. Beyond some
/// turning a second derivative says nothing of where it ends any more, and grows with its square.
double followed_share(const SolverBody& a, const SolverBody& b, double hs) {
  const double square = std::max(a.w.squaredNorm(), b.w.squaredNorm()) * hs * hs;
  return square > tolerances::max_turn_per_substep * tolerances::max_turn_per_substep
             ? tolerances::max_turn_per_substep * tolerances::max_turn_per_substep / square
             : 1;
}

void push_joint(const SolverIsland& island, const JointBlock& joint, const Values& impulse) {
  const JointPush push = push_of(joint, impulse);
  SolverBody& a = island.bodies[joint.a];
  SolverBody& b = island.bodies[joint.b];
  a.v -= a.inverse_mass * push.impulse;
  a.w += a.inverse_inertia * push.moment_a;
  b.v += b.inverse_mass * push.impulse;
  b.w += b.inverse_inertia * push.moment_b;
}

double line_velocity(const SolverBody& a, const SolverBody& b, const JointBlock::Line& row) {
  return row.linear.dot(b.v - a.v) + row.angular_a.dot(a.w) + row.angular_b.dot(b.w);
}

/// The rows of the coordinates, from eliminated velocities to changes of impulses, negative.
void solve_drives(const SolverIsland& island, const JointBlock& joint, const Values& impulse,
                  Values& x) {
  const uint32_t first = joint.kept, n = joint.count;
  const auto compliance = [&](uint32_t i, uint32_t k) {
    return i < k ? joint.factor[k][i] : joint.factor[i][k];
  };
  Values change{};
  const int sweeps = n - first > 1 ? tolerances::drive_sweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (uint32_t i = first; i < n; ++i) {
      double free = x[i] - compliance(i, i) * impulse[i];
      for (uint32_t k = first; k < n; ++k)
        if (k != i) free += compliance(i, k) * change[k];
      change[i] = island.drives[joint.first_drive + i - first].solve(free) - impulse[i];
    }
  for (uint32_t i = first; i < n; ++i) x[i] = -change[i];
}

void solve_joint(const SolverIsland& island, double hs, const Softness& stiffness, JointPass pass,
                 JointBlock& joint) {
  const bool moving = pass == JointPass::moving;
  const Softness soft = moving ? stiffness : Softness{};
  const SolverBody& a = island.bodies[joint.a];
  const SolverBody& b = island.bodies[joint.b];
  Values& impulse = moving ? joint.moving : joint.relaxing;
  Values change;
  for (uint32_t i = joint.kept; i < joint.count; ++i)
    change[i] = line_velocity(a, b, joint.lines[i]);
  for (uint32_t i = 0; i < joint.kept; ++i) {
    const JointBlock::Line& row = joint.lines[i];
    // The end of the sub-step is C + hs J v + hs^2/2 (dJ/dt v).
    const double correction =
        std::clamp(soft.bias_rate * row.error, -tolerances::max_joint_correction,
                   tolerances::max_joint_correction);
    const double target = moving ? correction + 0.5 * hs * row.bias : 0;
    change[i] = line_velocity(a, b, row) + target;
  }
  eliminate(joint, change);
  if (joint.count > joint.kept) solve_drives(island, joint, impulse, change);
  substitute(joint, change);
  for (uint32_t i = 0; i < joint.count; ++i) {
    change[i] = i < joint.kept ? -soft.mass_scale * change[i] - soft.impulse_scale * impulse[i]
                               : -change[i];
    impulse[i] += change[i];
  }
  push_joint(island, joint, change);
}

std::span<DriveRow> drives_of(const SolverIsland& island, const JointBlock& joint) {
  return island.drives.subspan(joint.first_drive, joint.count - joint.kept);
}

/// Force laws of a pass, before any impulse of it.
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
      if (pass == JointPass::relaxing && d.bounced) joint.relaxing[joint.kept + k] = 0;
    }
  }
}

/// The rows of the coordinates at the present poses and velocities.
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
    // A second derivative says nothing of what goes on beyond the motion itself.
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
    joint.sum.add(push_of(joint, pass == JointPass::moving ? joint.moving : joint.relaxing));
    for (DriveRow& d : drives_of(island, joint)) {
      d.add_up();
      if (pass == JointPass::moving)
        d.end_moving(hs, island.kick);
      else
        d.end_relaxing();
    }
  }
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
    for (DriveRow& d : drives_of(island, joint)) d.value = from.value[d.coordinate];
  }
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
    rows.clear();
    joint_rows(from.kind, sides, rows);
    refresh_drives(island, hs, kind, sides, joint);
    const double share = followed_share(island.bodies[joint.a], island.bodies[joint.b], hs);
    for (uint32_t i = 0; i < joint.kept; ++i) {
      const JointRow& r = rows[i];
      joint.lines[i] = {r.row.b.linear, r.row.a.angular, r.row.b.angular, r.error, share * r.bias};
    }
    set_effective_mass(island.bodies[joint.a], island.bodies[joint.b], joint);
    for (uint32_t i = joint.kept; i < joint.count; ++i)
      drives_of(island, joint)[i - joint.kept].mass = joint.factor[i][i];
  }
}

void warm_start_joints(const SolverIsland& island, double hs, JointPass pass) {
  start_drives(island, hs, pass);
  const double most =
      tolerances::max_turn_per_substep * tolerances::max_turn_per_substep / (hs * hs);
  const auto turns_away = [&](const SolverBody& body, const Vec3& moment) {
    return body.w.squaredNorm() > most && (body.inverse_inertia * moment).squaredNorm() > most;
  };
  for (JointBlock& joint : island.joints) {
    Values& impulse = pass == JointPass::moving ? joint.moving : joint.relaxing;
    const JointPush push = push_of(joint, impulse);
    if (turns_away(island.bodies[joint.a], push.moment_a) ||
        turns_away(island.bodies[joint.b], push.moment_b))
      impulse.fill(0);
    else
      push_joint(island, joint, impulse);
  }
}

void solve_joints(const SolverIsland& island, double hs, const Softness& stiffness,
                  JointPass pass) {
  for (int k = 0; k < island.joint_sweeps; ++k) {
    if (k % 2 == 0) {
      for (JointBlock& joint : island.joints) solve_joint(island, hs, stiffness, pass, joint);
    } else {
      for (size_t i = island.joints.size(); i-- > 0;)
        solve_joint(island, hs, stiffness, pass, island.joints[i]);
    }
  }
}

double store_joints(const SolverContext& c, const SolverIsland& island, double hs) {
  double residual = 0;
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
      to.relaxing_force[k] = d.bounced ? 0 : joint.relaxing[i] / hs;
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
