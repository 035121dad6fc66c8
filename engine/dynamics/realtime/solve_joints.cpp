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

/// L D L^T in place of the lower triangle; rows that depend on the ones before get no impulse.
void factorise(std::array<Values, JointBlock::most>& k, uint32_t n) {
  for (uint32_t j = 0; j < n; ++j) {
    const double diagonal = k[j][j];
    Values scaled;
    for (uint32_t m = 0; m < j; ++m) {
      scaled[m] = k[j][m];  // L D
      k[j][m] *= k[m][m];
    }
    double d = diagonal;
    for (uint32_t m = 0; m < j; ++m) d -= scaled[m] * k[j][m];
    k[j][j] = d > tolerances::dependent_row * diagonal ? 1 / d : 0;
    for (uint32_t i = j + 1; i < n; ++i) {
      for (uint32_t m = 0; m < j; ++m) k[i][j] -= k[i][m] * k[j][m];
    }
  }
}

/// x = K^-1 x.
void solve_factored(const std::array<Values, JointBlock::most>& k, uint32_t n, Values& x) {
  for (uint32_t i = 0; i < n; ++i)
    for (uint32_t m = 0; m < i; ++m) x[i] -= k[i][m] * x[m];
  for (uint32_t i = 0; i < n; ++i) x[i] *= k[i][i];
  for (uint32_t i = n; i-- > 0;)
    for (uint32_t m = i + 1; m < n; ++m) x[i] -= k[m][i] * x[m];
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
  factorise(joint.factor, joint.count);
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
  const auto [linear, turn_a, turn_b] = push_of(joint, impulse);
  SolverBody& a = island.bodies[joint.a];
  SolverBody& b = island.bodies[joint.b];
  a.v -= a.inverse_mass * linear;
  a.w += a.inverse_inertia * turn_a;
  b.v += b.inverse_mass * linear;
  b.w += b.inverse_inertia * turn_b;
}

double line_velocity(const SolverBody& a, const SolverBody& b, const JointBlock::Line& row) {
  return row.linear.dot(b.v - a.v) + row.angular_a.dot(a.w) + row.angular_b.dot(b.w);
}

void solve_joint(const SolverIsland& island, double hs, const Softness& stiffness, JointPass pass,
                 JointBlock& joint) {
  const bool moving = pass == JointPass::moving;
  const Softness soft = moving ? stiffness : Softness{};
  const SolverBody& a = island.bodies[joint.a];
  const SolverBody& b = island.bodies[joint.b];
  Values& impulse = moving ? joint.moving : joint.relaxing;
  Values change;
  for (uint32_t i = 0; i < joint.count; ++i) {
    const JointBlock::Line& row = joint.lines[i];
    // The end of the sub-step is C + hs J v + hs^2/2 (dJ/dt v).
    const double correction =
        std::clamp(soft.bias_rate * row.error, -tolerances::max_joint_correction,
                   tolerances::max_joint_correction);
    const double target = moving ? correction + 0.5 * hs * row.bias : 0;
    change[i] = line_velocity(a, b, row) + target;
  }
  solve_factored(joint.factor, joint.count, change);
  for (uint32_t i = 0; i < joint.count; ++i) {
    change[i] = -soft.mass_scale * change[i] - soft.impulse_scale * impulse[i];
    impulse[i] += change[i];
  }
  push_joint(island, joint, change);
}

}  // namespace

void sum_joints(const SolverIsland& island, JointPass pass) {
  for (JointBlock& joint : island.joints) {
    const JointPush push =
        push_of(joint, pass == JointPass::moving ? joint.moving : joint.relaxing);
    joint.sum.impulse += push.impulse;
    joint.sum.moment_a += push.moment_a;
    joint.sum.moment_b += push.moment_b;
  }
}

Softness joint_softness(double hs) {
  return soft_step(tolerances::joint_frequency_share / hs, tolerances::joint_damping_ratio, hs);
}

void prepare_joints(const SolverContext& c, const SolverIsland& island, double hs) {
  for (JointBlock& joint : island.joints) {
    const Joint& from = c.joints[joint.source];
    joint.sum = {};
    for (size_t i = 0; i < JointBlock::most; ++i) {
      joint.moving[i] = hs * from.moving_force[i];
      joint.relaxing[i] = hs * from.relaxing_force[i];
    }
  }
  refresh_joints(c, island, hs);
}

void refresh_joints(const SolverContext& c, const SolverIsland& island, double hs) {
  JointRows rows;
  for (JointBlock& joint : island.joints) {
    const Joint& from = c.joints[joint.source];
    const bool axes = entry_of(from.kind).uses_axes;
    const JointSides sides{side_now(c, island, from.a, joint.a, from.frame_a, axes),
                           side_now(c, island, from.b, joint.b, from.frame_b, axes), from.length};
    rows.clear();
    joint_rows(from.kind, sides, rows);
    joint.count = uint32_t(rows.size());
    const double share = followed_share(island.bodies[joint.a], island.bodies[joint.b], hs);
    for (uint32_t i = 0; i < joint.count; ++i) {
      const JointRow& r = rows[i];
      joint.lines[i] = {r.row.b.linear, r.row.a.angular, r.row.b.angular, r.error, share * r.bias};
    }
    set_effective_mass(island.bodies[joint.a], island.bodies[joint.b], joint);
  }
}

void warm_start_joints(const SolverIsland& island, double hs, JointPass pass) {
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
  for (const JointBlock& joint : island.joints) {
    Joint& to = c.joints[joint.source];
    if (!c.joint_pushes.empty()) c.joint_pushes[joint.source] = joint.sum;
    const SolverBody& a = island.bodies[joint.a];
    const SolverBody& b = island.bodies[joint.b];
    for (uint32_t i = 0; i < joint.count; ++i) {
      to.moving_force[i] = joint.moving[i] / hs;
      to.relaxing_force[i] = joint.relaxing[i] / hs;
      residual = std::max(residual, std::fabs(line_velocity(a, b, joint.lines[i])));
    }
  }
  return residual;
}

}  // namespace tumble
