#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <algorithm>
#include <span>

namespace tumble {

// Code that the loops of single and of coupled joints share.

/// Pose and velocity of a side of a joint within the tick.
JointSide side_now(const SolverContext& context, const SolverIsland& island, uint32_t slot,
                   uint32_t local, const Pose& frame, bool uses_axes);

inline double line_velocity(const SolverBody& a, const SolverBody& b, const JointBlock::Line& row) {
  return row.linear.dot(b.v - a.v) + row.angular_a.dot(a.w) + row.angular_b.dot(b.w);
}

/// The impulse and moments of one impulse along a line.
inline JointPush push_of(const JointBlock::Line& line, double impulse) {
  JointPush push;
  push.impulse = impulse * line.linear;
  push.moment_a = impulse * line.angular_a;
  push.moment_b = impulse * line.angular_b;
  return push;
}

// Lines with up to four ends.

inline void add_end(CoupledJoints::Line& line, uint32_t body, const Vec3& linear,
                    const Vec3& angular) {
  line.body[line.ends] = body;
  line.linear[line.ends] = linear;
  line.angular[line.ends] = angular;
  ++line.ends;
}
inline void add_ends(CoupledJoints::Line& line, uint32_t a, uint32_t b,
                     const JointBlock::Line& of) {
  add_end(line, a, -of.linear, of.angular_a);
  add_end(line, b, of.linear, of.angular_b);
}
inline double line_velocity(const SolverIsland& island, const CoupledJoints::Line& line) {
  double v = 0;
  for (uint32_t k = 0; k < line.ends; ++k) {
    const SolverBody& body = island.bodies[line.body[k]];
    v += line.linear[k].dot(body.v) + line.angular[k].dot(body.w);
  }
  return v;
}
inline void push_line(const SolverIsland& island, const CoupledJoints::Line& line, double impulse) {
  for (uint32_t k = 0; k < line.ends; ++k) {
    SolverBody& body = island.bodies[line.body[k]];
    body.v += impulse * body.inverse_mass * line.linear[k];
    body.w += impulse * (body.inverse_inertia * line.angular[k]);
  }
}
/// The entry of J M^-1 J^T of two lines.
inline double line_product(const SolverIsland& island, const CoupledJoints::Line& p,
                           const CoupledJoints::Line& q) {
  double sum = 0;
  for (uint32_t i = 0; i < p.ends; ++i)
    for (uint32_t k = 0; k < q.ends; ++k) {
      if (p.body[i] != q.body[k]) continue;
      const SolverBody& body = island.bodies[p.body[i]];
      sum += body.inverse_mass * p.linear[i].dot(q.linear[k]) +
             (body.inverse_inertia * p.angular[i]).dot(q.angular[k]);
    }
  return sum;
}

/// The change of a kept row's impulse that removes a velocity, given as velocity / mass (multiplied
/// by the effective mass).
inline double kept_change(double velocity_over_mass, double impulse, const Softness& soft,
                          JointPass pass) {
  if (pass != JointPass::correcting) return -velocity_over_mass;
  return -soft.mass_scale * velocity_over_mass - soft.impulse_scale * impulse;
}

inline std::span<DriveRow> drives_of(const SolverIsland& island, const JointBlock& joint) {
  return island.drives.subspan(joint.first_drive, joint.count - joint.kept);
}

/// Share of the second-order term of a joint's lines that is taken into account in a sub-step.
/// Beyond max_turn_per_substep the term, which grows with the square of the rotation, no longer
/// predicts the end of the sub-step, and is limited.
inline double followed_share(const SolverBody& a, const SolverBody& b, double hs) {
  const double square = std::max(a.w.squaredNorm(), b.w.squaredNorm()) * hs * hs;
  return square > tolerances::max_turn_per_substep * tolerances::max_turn_per_substep
             ? tolerances::max_turn_per_substep * tolerances::max_turn_per_substep / square
             : 1;
}

/// Whether a body turns so far in a sub-step that the previous impulse, which by itself would turn
/// it as far again, would act in a wrong direction by now.
inline bool turns_away(const SolverBody& body, const Vec3& moment, double hs) {
  const double most =
      tolerances::max_turn_per_substep * tolerances::max_turn_per_substep / (hs * hs);
  return body.w.squaredNorm() > most && (body.inverse_inertia * moment).squaredNorm() > most;
}

/// The velocity that a kept row must lose, with the terms that the pass adds: the constraint at the
/// end of the sub-step is C + hs J v + hs^2/2 (dJ/dt v).
inline double kept_velocity(double velocity, double error, double bias, double hs,
                            const Softness& soft, JointPass pass) {
  if (pass == JointPass::relaxing) return velocity;
  velocity += 0.5 * hs * bias;
  if (pass == JointPass::correcting)
    velocity += std::clamp(soft.bias_rate * error, -tolerances::max_joint_correction,
                           tolerances::max_joint_correction);
  return velocity;
}

}  // namespace tumble
