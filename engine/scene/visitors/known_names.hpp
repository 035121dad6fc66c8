#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// What may stand for a parameter that names an algorithm (`stepper`, `broad_phase`,
/// `hierarchy`, `narrow_phase`, `contact_time`, `integrator`, `impulses`, `contact_solver`,
/// `friction_cone`, `volumes`, `algorithm` of a microscope), from the engine's lists, and of what
/// the viewer draws (`overlays`); empty for other parameters.
std::vector<std::string> known_names(std::string_view parameter);

}  // namespace tumble
