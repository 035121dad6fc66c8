#pragma once
#include "engine/world/microscope/difference_space.hpp"

namespace tumble {

/// Appends the steps of EPA, which starts from GJK's last simplex. Returns minus the penetration
/// depth, radii of rounding included [m].
double record_epa(const DifferenceSpace& space, const Simplex& start,
                  std::vector<MicroscopeStep>& steps);

}  // namespace tumble
