#pragma once
#include "engine/scene/build.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// By what factor one step of an integrator of the event stepper multiplies the amplitude of a
/// damped oscillator x'' + 2 d x' + w^2 x = 0, from its stability function. Above 1 it grows.
/// Integrators that choose their steps, or are stable at any, give 0.
double amplification(std::string_view integrator, double w, double d, double h);

/// Under the event stepper: springs that oscillate too fast for the integrator and the tick, which
/// then give energy instead of keeping it. A sentence about the worst, with the name of a spring
/// and the tick that holds it.
std::vector<std::string> spring_limit_warnings(const BuiltScene& built);

}  // namespace tumble
