#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// Factor by which a step of an integrator of the event stepper multiplies the amplitude of a
/// damped oscillator x'' + 2 d x' + w^2 x = 0, from its stability function; above 1 the step is
/// unstable. 0 for integrators that are adaptive or unconditionally stable.
double amplification(std::string_view integrator, double w, double d, double h);

/// For the event stepper: springs that oscillate too fast for the integrator and the tick, and so
/// gain energy. A message about the worst, with the name of a spring and a sufficient tick.
std::vector<std::string> spring_limit_warnings(const BuiltScene& built);

}  // namespace tumble
