#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/course_motion.hpp"
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
  uint64_t contacts = 0;  ///< number of contacts that were solved
  uint64_t points = 0;
  uint64_t joints = 0;        ///< number of joints that were solved
  double residual = 0;        ///< greatest approach speed left at a pressed point [m/s]
  double joint_residual = 0;  ///< greatest velocity left in a row of a joint [m/s, rad/s]

  /// Adds the statistics of another part of the bodies.
  void add(const RealtimeSolveStats& other);
};

/// Moves bodies over one tick under gravity, their sums of force and torque, contacts and joints.
///
/// Soft contacts with sub-steps after E. Catto, "Solver2D" (2024), with the soft step of "Soft
/// Constraints" (GDC 2011): each sub-step integrates velocities, warm starts, sweeps once with
/// bias, integrates positions, and sweeps once without bias (relaxing); restitution follows the
/// last sub-step. Friction is bounded by a disc of radius mu times the normal impulse in the
/// tangent plane. The number of sub-steps of an island depends on the island itself (SolvePlan). In
/// free flight rotation conserves angular momentum exactly.
class RealtimeSolver {
 public:
  RealtimeSolver();
  ~RealtimeSolver();
  RealtimeSolver(RealtimeSolver&&) noexcept;
  RealtimeSolver& operator=(RealtimeSolver&&) noexcept;

  /// To be called before the first step of a tick: Joint::impulse and motor_impulse are sums over
  /// the steps since then. Those of a joint that no step solves, because its bodies sleep, stay
  /// what they were in the last tick that solved it.
  void begin_tick();

  /// Moves every awake dynamic body of `islands` and every kinematic body. Writes back poses and
  /// velocities, the impulses of contacts, of the joints that the islands name and of their
  /// couplings, and those of `springs`, whose links were used in building the islands. `h` [s] may
  /// be a part of the tick, of which `passed` seconds are over. The velocities of kinematic bodies
  /// are means over `h`, about which those on `courses` change at a constant rate. RigidBody::force
  /// and torque exclude gravity and stay unchanged. Islands are solved in parallel on `crew`; the
  /// result does not depend on the number of threads. Error `numeric` names the first body slot
  /// that became non-finite and its deepest contact; the state of the bodies is then undefined.
  Result<RealtimeSolveStats> step(std::span<RigidBody> bodies, ContactSet& contacts,
                                  const IslandSet& islands, const Vec3& gravity, double h,
                                  const RealtimeSettings& settings, Crew& crew,
                                  std::span<Joint> joints = {},
                                  std::span<JointCoupling> couplings = {}, double passed = 0,
                                  std::span<SolvedSpring> springs = {},
                                  std::span<const CourseMotion> courses = {});

  /// By joint index: impulses of the joints on their bodies in the last step, for joints that its
  /// islands name.
  std::span<const JointPush> joint_pushes() const;

  void add_memory(MemoryUse& use) const;

  /// Scratch memory only: no state outlives a tick.
 private:
  struct Scratch;
  std::unique_ptr<Scratch> scratch_;
};

}  // namespace tumble
