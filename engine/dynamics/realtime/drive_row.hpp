#pragma once
#include "engine/dynamics/joints/coordinate_drive.hpp"
#include "engine/dynamics/joints/force_law.hpp"
#include "engine/dynamics/realtime/joint_pass.hpp"

#include <array>
#include <cstdint>

namespace tumble {

/// What acts along one coordinate of a joint, within the sub-steps of a tick. In either pass it is
/// a force law of the velocity along the coordinate at the end of that pass. With x for the value
/// and v for the velocity that moves the bodies from one to the next:
///   springs      implicit midpoint rule, k (x + hs v/2 - rest) in both passes;
///   dampers      implicit in the moving pass; in the relaxing pass partly implicit, by the share
///                at which a damper alone decays as exp says: of second order, stable at any
///                strength, with the right speed under a steady force;
///   hard limits  the end of the sub-step is within them, then velocity leads away from them;
///   bounds       of forces times half of the sub-step, in each pass.
struct DriveRow {
  /// Parts of the law that are told apart afterwards.
  enum Cause : uint8_t { motor, friction, lower, upper, other };
  static constexpr size_t causes = 5;
  using Shares = std::array<double, causes>;

  const CoordinateDrive* drive = nullptr;
  uint32_t coordinate = 0;  ///< in the list of the joint's kind

  // Of the present pass.
  double value = 0;   ///< [m] or [rad]
  double curve = 0;   ///< hs^2/2 dJ/dt v: what bending adds to the value in a sub-step
  double rate = 0;    ///< at the end of the pass before: what armature remembers
  double before = 0;  ///< velocity along it before any impulse of the pass
  double free = 0;    ///< with `nears_limit`: that of the moving pass without the limits
  double mass = 0;    ///< compliance: velocity that a unit of impulse gives
  ForceLaw law;
  std::array<uint8_t, ForceLaw::most_parts> cause_of{};
  Shares shares{};        ///< impulses of the pass
  double v = 0;           ///< velocity along it at the end of the pass
  double t = 0;           ///< start of the sub-step since the tick began [s]
  double motor_rate = 0;  ///< that a motor of velocity holds
  double noted = 0;       ///< v before a pass, then before a blow

  // Of the moving pass, for the relaxing one.
  double moved = 0;  ///< velocity that moved the bodies
  Shares springs{};  ///< impulses of springs alone, without dampers and bounds
  double bounce_lower = 0, bounce_upper = 0;  ///< speed after an impact on a limit, 0: none
  double held_lower = 0, held_upper = 0;      ///< impulses of the limits
  double blow = 0;                            ///< that of a bounce, while it is solved
  bool at_lower = false, at_upper = false;
  /// A limit that bounces may be met in this sub-step. The speed of the impact is that of the whole
  /// mechanism, so the moving pass is solved without the limits first.
  bool nears_limit = false;

  // Of the sub-steps so far.
  double motor_impulse = 0, motor_work = 0, friction_work = 0, limit_work = 0;

  /// The law of a pass of a sub-step of `hs` seconds.
  void set_law(JointPass pass, double hs);
  /// After the moving pass without limits, which gave the velocity `without`: the law with them.
  void put_limits(double without, double hs);
  /// The impulse of the pass, where the velocity without it were `free`.
  double solve(double free);
  /// After the moving pass; forces had acted for `kick` seconds before it.
  void end_moving(double hs, double kick);
  /// After the relaxing pass.
  void end_relaxing(double hs) { t += hs; }
  /// The velocity that a motor holds, 0 where none does: energy of blows is that seen by who goes
  /// along with it.
  double held_rate() const { return holds_rate() ? motor_rate : 0; }
  /// What holds the coordinate, and its armature, took of the motion since `noted`, where the
  /// velocity along it went from `first` to `last`. Springs, dampers and motors of force take
  /// nothing: they are forces.
  double taken(double first, double last) const;
  /// Whether a limit gives back a blow in the relaxing pass.
  bool bounces() const { return bounce_lower > 0 || bounce_upper > 0; }
  /// After either pass.
  void add_up();

 private:
  void set_moving(double hs);
  bool may_bounce(double hs) const;
  void put_hard_limits(double hs);
  void set_relaxing(double hs);
  void put(Cause cause, double force, double gain, double least, double most);
  /// Where it is: see ForceLaw::add_step.
  double put_step(Cause cause, double at, double least, double most);
  bool holds_rate() const;
  double implicit_share(double hs) const;
};

}  // namespace tumble
