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
