#pragma once
#include "engine/core/handle.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

class TimeCourse;

struct JointTag;
using JointId = Handle<JointTag>;

inline constexpr double no_bound = std::numeric_limits<double>::infinity();

/// Limits of a coordinate. Units here and below: a coordinate x is a length [m] or an angle [rad],
/// and its force accordingly a force [N] or a torque [N m].
struct CoordinateLimits {
  double lower = -no_bound, upper = no_bound;  ///< [m] or [rad]
  /// Beyond a soft limit a damped spring pushes back and never pulls. Stiffness 0: the limit is
  /// hard.
  double stiffness = 0;    ///< [N/m] or [N m/rad]
  double damping = 0;      ///< [N s/m] or [N m s/rad]
  double restitution = 0;  ///< of a hard limit: speed after an impact over that before, 0..1 [-]

  bool exist() const { return lower > -no_bound || upper < no_bound; }
  bool hard() const { return stiffness == 0; }
};

enum class MotorKind : uint8_t {
  none,
  velocity,  ///< holds a rate with any force up to the greatest
  position,  ///< pulls towards a value with stiffness and damping, up to the greatest force
  force,     ///< a constant force
};

struct CoordinateMotor {
  MotorKind kind = MotorKind::none;
  double target = 0;            ///< a rate, value or force, by kind
  double stiffness = 0;         ///< of a position motor [N/m] or [N m/rad]
  double damping = 0;           ///< of a position motor [N s/m] or [N m s/rad]
  double max_force = no_bound;  ///< [N] or [N m]
  /// Rate of change of the target within a tick; `target` is its value at the start [1/s]
  double target_rate = 0;
  /// In a definition: the target as a function of time; null: constant. Within a tick it is
  /// interpolated linearly from its value at the start to that at the end, with an error of second
  /// order in the tick.
  std::shared_ptr<const TimeCourse> course;

  double target_at(double since_tick) const { return target + since_tick * target_rate; }
  /// Whether it acts like a constraint with a prescribed rate.
  bool holds_rate_with_any_force() const {
    return kind == MotorKind::velocity && max_force == no_bound;
  }
};

struct CoordinateSpring {
  double stiffness = 0;  ///< [N/m] or [N m/rad]
  double damping = 0;    ///< [N s/m] or [N m s/rad]
  double rest = 0;       ///< value without force [m] or [rad]
};

/// Couples the coordinate to another one, of another joint or of the same: x = ratio y + offset.
/// Gears and belts couple two angles, racks and screws an angle and a length.
struct CoordinateCouple {
  JointId joint;            ///< null: the same joint
  uint32_t coordinate = 0;  ///< index among the coordinates of the other joint's kind
  double ratio = 1;         ///< change of x by change of y [-], [m/rad] or [rad/m]
  double offset = 0;        ///< x at y = 0 [m] or [rad]
};

/// Everything that acts along one coordinate of a joint. Apart from a coupling it is one force law
/// F(x, dx/dt) that never increases with the rate: friction, dampers, motors and limits all resist
/// faster motion more.
struct CoordinateDrive {
  CoordinateLimits limits;
  CoordinateMotor motor;
  CoordinateSpring spring;
  double friction = 0;  ///< greatest force of dry friction [N] or [N m]
  double armature = 0;  ///< inertia along the coordinate, as of a geared rotor [kg] or [kg m2]
  std::optional<CoordinateCouple> couple;

  /// Whether there is any force law (couplings do not count).
  bool acts() const {
    return limits.exist() || motor.kind != MotorKind::none || spring.stiffness > 0 ||
           spring.damping > 0 || friction > 0 || armature > 0;
  }
};

/// The greatest number of coordinates of any kind of joint.
inline constexpr size_t most_coordinates = 3;
/// By coordinate, in the order of the kind's list.
using JointDrives = std::array<CoordinateDrive, most_coordinates>;

/// What is wrong with a drive, with the value; empty if nothing is.
std::string fault_of(const CoordinateDrive& drive);

/// Whether any part of the force is discontinuous in the rate: hard limits, a motor that holds a
/// rate, dry friction.
bool acts_by_steps(const CoordinateDrive& drive);

/// Potential energy of the spring and of soft limits at a value [J].
double potential_energy(const CoordinateDrive& drive, double value);

}  // namespace tumble
