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

/// Where a coordinate must stay. Units here and below: a coordinate x is a length [m] or an angle
/// [rad], its force is a force [N] or a torque [N m].
struct CoordinateLimits {
  double lower = -no_bound, upper = no_bound;  ///< [m] or [rad]
  /// Beyond a limit a spring with a damper pushes back, never pulls; 0: the limit is hard.
  double stiffness = 0;    ///< [N/m] or [N m/rad]
  double damping = 0;      ///< [N s/m] or [N m s/rad]
  double restitution = 0;  ///< of a hard limit: speed after an impact over that before, 0..1 [-]

  bool exist() const { return lower > -no_bound || upper < no_bound; }
  bool hard() const { return stiffness == 0; }
};

enum class MotorKind : uint8_t {
  none,
  velocity,  ///< holds a rate, with whatever force that takes up to the greatest
  position,  ///< pulls towards a value by stiffness and damping, up to the greatest force
  force,     ///< a constant force
};

struct CoordinateMotor {
  MotorKind kind = MotorKind::none;
  double target = 0;            ///< a rate, a value or a force, by kind
  double stiffness = 0;         ///< of a position motor [N/m] or [N m/rad]
  double damping = 0;           ///< of a position motor [N s/m] or [N m s/rad]
  double max_force = no_bound;  ///< [N] or [N m]
  double target_rate = 0;       ///< its change within a tick, at whose start it is as given [1/s]
  /// In a definition: what the target is over time; null: as given. Within a tick it goes straight
  /// from what it is at its start to what it is at its end, which is of second order in the tick.
  std::shared_ptr<const TimeCourse> course;

  double target_at(double since_tick) const { return target + since_tick * target_rate; }
  /// Whether it is as good as a joint that moves.
  bool holds_rate_with_any_force() const {
    return kind == MotorKind::velocity && max_force == no_bound;
  }
};

struct CoordinateSpring {
  double stiffness = 0;  ///< [N/m] or [N m/rad]
  double damping = 0;    ///< [N s/m] or [N m s/rad]
  double rest = 0;       ///< value at which it does not pull [m] or [rad]
};

/// The coordinate follows another one, which must not be itself: x = ratio y + offset, with y of
/// another joint or of the same one. Gears and belts tie angles, racks and screws an angle and a
/// length.
struct CoordinateCouple {
  JointId joint;            ///< null: the same joint
  uint32_t coordinate = 0;  ///< in the list of the other joint's kind
  double ratio = 1;         ///< change of x by change of y [-], [m/rad] or [rad/m]
  double offset = 0;        ///< x where y is 0 [m] or [rad]
};

/// All that acts along one coordinate of a joint. But for what couples it, it is one force law
/// F(x, dx/dt) that never grows with the rate: friction, dampers, motors and limits all resist
/// motion more the faster it is.
struct CoordinateDrive {
  CoordinateLimits limits;
  CoordinateMotor motor;
  CoordinateSpring spring;
  double friction = 0;  ///< greatest force of dry friction [N] or [N m]
  double armature = 0;  ///< inertia along the coordinate, of a geared rotor [kg] or [kg m2]
  std::optional<CoordinateCouple> couple;

  /// Whether there is any force law.
  bool acts() const {
    return limits.exist() || motor.kind != MotorKind::none || spring.stiffness > 0 ||
           spring.damping > 0 || friction > 0 || armature > 0;
  }
};

/// No kind of joint has more coordinates.
inline constexpr size_t most_coordinates = 3;
/// By coordinate, in the order of the kind's list.
using JointDrives = std::array<CoordinateDrive, most_coordinates>;

/// What is wrong with a drive, empty if nothing: it names the value.
std::string fault_of(const CoordinateDrive& drive);

/// Whether there is anything whose force jumps with the rate: hard limits, a motor that holds a
/// rate, dry friction.
bool acts_by_steps(const CoordinateDrive& drive);

/// Potential energy of spring and compliant limits at a value [J].
double potential_energy(const CoordinateDrive& drive, double value);

}  // namespace tumble
