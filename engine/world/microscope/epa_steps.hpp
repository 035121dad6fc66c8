#pragma once
#include "engine/world/microscope/difference_space.hpp"

namespace tumble {

/// Appends the steps of EPA from GJK's last simplex on. Returns minus the depth, roundings included
/// [m].
double record_epa(const DifferenceSpace& space, const Simplex& start,
                  std::vector<MicroscopeStep>& steps);

}  // namespace tumble
