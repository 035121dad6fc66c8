#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// The names allowed for a parameter that selects an algorithm (`stepper`, `broad_phase`,
/// `hierarchy`, `narrow_phase`, `contact_time`, `integrator`, `impulses`, `contact_solver`,
/// `friction_cone`, `volumes`, `algorithm` of a microscope), from the engine's lists, or an overlay
/// of the viewer (`overlays`); empty for other parameters.
std::vector<std::string> known_names(std::string_view parameter);

}  // namespace tumble
