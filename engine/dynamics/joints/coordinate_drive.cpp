#include "engine/dynamics/joints/coordinate_drive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace tumble {

std::string fault_of(const CoordinateDrive& d) {
  using Named = std::pair<const char*, double>;
  for (const auto& [name, value] :
       {Named{"limits.stiffness", d.limits.stiffness}, Named{"limits.damping", d.limits.damping},
        Named{"motor.stiffness", d.motor.stiffness}, Named{"motor.damping", d.motor.damping},
        Named{"spring.stiffness", d.spring.stiffness}, Named{"spring.damping", d.spring.damping},
        Named{"friction", d.friction}, Named{"armature", d.armature}})
    if (!(value >= 0 && std::isfinite(value)))
      return fmt::format("{} must be finite and not negative, got {}", name, value);
  if (!(d.motor.max_force >= 0))
    return fmt::format("motor.max_force must not be negative, got {}", d.motor.max_force);
  if (!std::isfinite(d.motor.target) || !std::isfinite(d.motor.target_rate))
    return "the target of a motor must be finite";
  if (!std::isfinite(d.spring.rest)) return "the rest of a spring must be finite";
  if (!(d.limits.lower <= d.limits.upper && d.limits.lower < no_bound &&
        d.limits.upper > -no_bound))
    return fmt::format("the lower limit must not be above the upper one, got {} and {}",
                       d.limits.lower, d.limits.upper);
  if (d.limits.hard() && d.limits.damping > 0)
    return "limits.damping needs limits.stiffness: a hard limit does not give way";
  if (!d.limits.hard() && d.limits.restitution > 0)
    return "limits.restitution is of hard limits: leave it out, or leave out limits.stiffness";
  if (!(d.limits.restitution >= 0 && d.limits.restitution <= 1))
    return fmt::format("limits.restitution must be in 0..1, got {}", d.limits.restitution);
  if (d.couple && !(std::isfinite(d.couple->ratio) && std::isfinite(d.couple->offset)))
    return fmt::format("ratio and offset of couple must be finite, got {} and {}", d.couple->ratio,
                       d.couple->offset);
  return {};
}

bool acts_by_steps(const CoordinateDrive& d) {
  return (d.limits.exist() && d.limits.hard()) || d.motor.kind == MotorKind::velocity ||
         d.friction > 0;
}

double potential_energy(const CoordinateDrive& d, double x) {
  const double stretch = x - d.spring.rest;
  double energy = 0.5 * d.spring.stiffness * stretch * stretch;
  if (d.limits.hard()) return energy;
  const double beyond = std::max({0.0, d.limits.lower - x, x - d.limits.upper});
  return energy + 0.5 * d.limits.stiffness * beyond * beyond;
}

}  // namespace tumble
