#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/joints/joint_coupling.hpp"
#include "engine/dynamics/joints/joint_push.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"
#include "engine/dynamics/realtime/spring_row.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace tumble {

struct RealtimeSolveStats {
  uint64_t islands = 0;
  uint64_t awake = 0;     ///< dynamic bodies that were integrated
  uint64_t contacts = 0;  ///< that were solved
  uint64_t points = 0;
  uint64_t joints = 0;        ///< that were solved
  double residual = 0;        ///< greatest approach speed left at a pressed point [m/s]
  double joint_residual = 0;  ///< greatest velocity left in a row of a joint [m/s, rad/s]

  /// Takes in what was solved besides.
  void add(const RealtimeSolveStats& other);
};

/// Advances bodies under gravity, their force and torque sums and their contacts by one tick.
///
/// Sub-stepped soft contacts: E. Catto, "Solver2D" (2024), with the soft step of "Soft Constraints"
/// (GDC 2011): each sub-step integrates velocities, warm starts, solves once with bias, integrates
/// positions and relaxes once without bias; restitution follows the last sub-step. Friction is a
/// disc of radius mu times the normal impulse in the tangent plane. How many sub-steps an island
/// takes follows from itself (SolvePlan). Rotation keeps angular momentum exactly where nothing
/// touches.
class RealtimeSolver {
 public:
  RealtimeSolver();
  ~RealtimeSolver();
  RealtimeSolver(RealtimeSolver&&) noexcept;
  RealtimeSolver& operator=(RealtimeSolver&&) noexcept;

  /// Moves every awake dynamic body of `islands` and every kinematic body; writes back poses,
  /// velocities and the impulses of contacts, of `joints`, which are those that the islands name,
  /// and of their couplings, and what `springs` did, of which the links made islands. `h` may be a
  /// part of the tick, of which `passed` seconds are over. RigidBody::force and torque are without
  /// gravity and stay as they are. Islands are solved in parallel inside `crew`; the result does
  /// not depend on the number of threads. Error `numeric` names the first body slot that became
  /// non-finite and its deepest contact; the bodies are then in an undefined state.
  Result<RealtimeSolveStats> step(std::span<RigidBody> bodies, ContactSet& contacts,
                                  const IslandSet& islands, const Vec3& gravity, double h,
                                  const RealtimeSettings& settings, Crew& crew,
                                  std::span<Joint> joints = {},
                                  std::span<JointCoupling> couplings = {}, double passed = 0,
                                  std::span<SolvedSpring> springs = {});

  /// What the joints that the islands of the last step name did to their bodies in it, by index.
  std::span<const JointPush> joint_pushes() const;

  void add_memory(MemoryUse& use) const;

  /// Memory of the solver only: nothing here outlives a step.
 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace tumble
