#pragma once
#include "engine/dynamics/joints/coordinate_drive.hpp"
#include "engine/dynamics/joints/force_law.hpp"
#include "engine/dynamics/realtime/joint_pass.hpp"

#include <array>
#include <cstdint>

namespace tumble {

/// Everything that acts along one coordinate of a joint, within the sub-steps of a tick. In either
/// pass it is a force law of the velocity along the coordinate at the end of that pass. With x for
/// the value of the coordinate at the start of the sub-step and v for the velocity with which the
/// bodies move:
///   springs      implicit midpoint rule, k (x + hs v/2 - rest) in both passes;
///   dampers      implicit in the moving pass; in the relaxing pass partly implicit, by the share
///                at which a damper alone decays as exp says: of second order, stable at any
///                strength, with the right speed under a steady force;
///   hard limits  the end of the sub-step is within them, then velocity leads away from them;
///   bounds       of forces times half of the sub-step, in each pass.
struct DriveRow {
  /// Parts of the law whose shares are reported separately.
  enum Cause : uint8_t { motor, friction, lower, upper, other };
  static constexpr size_t causes = 5;
  using Shares = std::array<double, causes>;

  const CoordinateDrive* drive = nullptr;
  uint32_t coordinate = 0;  ///< index among the coordinates of the joint's kind

  // Values of the present pass.
  double value = 0;   ///< of the coordinate [m] or [rad]
  double curve = 0;   ///< hs^2/2 dJ/dt v: what curvature adds to the value in a sub-step
  double rate = 0;    ///< at the end of the previous pass: enters the momentum of the armature
  double before = 0;  ///< velocity along the coordinate before any impulse of the pass
  double free = 0;    ///< if `nears_limit`: velocity after the moving pass without the limits
  double mass = 0;    ///< compliance: change of velocity per impulse
  ForceLaw law;
  std::array<uint8_t, ForceLaw::most_parts> cause_of{};
  Shares shares{};  ///< impulses of the pass, by cause
  /// Impulses of motor and friction in a hit before the pass: together with those of the pass they
  /// are within the bounds of a pass.
  Shares spent{};
  double v = 0;           ///< velocity along the coordinate at the end of the pass
  double t = 0;           ///< start of the sub-step, since the tick began [s]
  double motor_rate = 0;  ///< velocity that a velocity motor holds
  double noted = 0;       ///< v before a pass, or before an impact

  // Results of the moving pass that the relaxing pass needs.
  double moved = 0;    ///< velocity with which the bodies moved
  double entered = 0;  ///< velocity along the coordinate before any of its impulses
  Shares springs{};    ///< impulses of springs alone, without dampers and bounds
  double bounce_lower = 0, bounce_upper = 0;  ///< speed after an impact on the limit; 0: no impact
  double held_lower = 0, held_upper = 0;      ///< impulses of the limits
  /// Impulse of a bouncing limit at the last blow_change().
  double blow = 0;
  bool at_lower = false, at_upper = false;
  /// A bouncing limit may be reached in this sub-step. The impact speed is that of the whole
  /// mechanism, so the moving pass is solved without the limits first.
  bool nears_limit = false;

  // Sums over the sub-steps so far.
  double motor_impulse = 0, motor_work = 0, friction_work = 0, limit_work = 0;

  /// Whether hard limits bounce. A motor of unlimited force would be back at the limit at once.
  bool limits_bounce() const;
  /// The rate that a velocity motor is to hold in a pass.
  double target_rate(JointPass pass, double hs) const;
  /// Sets up the law for a pass of a sub-step of `hs` seconds.
  void set_law(JointPass pass, double hs);
  /// Adds the limits to the law after a moving pass without them, which gave the velocity
  /// `without`.
  void put_limits(double without, double hs);
  /// The impulse of the pass, given the velocity `free` that there would be without it.
  double solve(double free);
  /// To be called after the moving pass, before which forces acted for `kick` seconds.
  void end_moving(double hs, double kick);
  /// To be called after the relaxing pass.
  void end_relaxing(double hs) { t += hs; }
  /// The velocity that a motor holds, or 0: energy of impacts is measured relative to that motion.
  double held_rate() const { return holds_rate() ? motor_rate : 0; }
  /// Energy that limits, brakes and motors that hold a velocity, and the armature, took since
  /// `noted`, where the velocity along the coordinate changed from `first` to `last`. Springs,
  /// dampers and motors of prescribed force count as forces and take none.
  double taken(double first, double last) const;
  /// Whether a limit bounces in the relaxing pass.
  bool bounces() const { return bounce_lower > 0 || bounce_upper > 0; }
  /// Adds impulse and work of a hit to the sums.
  void add_hit(Cause cause, double impulse, double work);
  /// Adds impulses and work of a pass to the sums; to be called after either pass. The work of a
  /// hard limit is that of its impulses in both passes at once: its impact falls into both, and in
  /// the first of them soft constraints keep a part of the speed that the impact takes.
  void add_up(JointPass pass);

 private:
  void set_moving(double hs);
  bool may_bounce(double hs) const;
  void put_hard_limits(double hs);
  void set_relaxing(double hs);
  void put(Cause cause, double force, double gain, double least, double most);
  /// Returns the velocity at which the step lies: see ForceLaw::add_step.
  double put_step(Cause cause, double at, double least, double most);
  bool holds_rate() const;
  double implicit_share(double hs) const;
};

}  // namespace tumble
