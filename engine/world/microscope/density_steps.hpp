#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why the frame is refused; "" when it has particles that may be a fluid whose pressures are
/// solved iteratively.
std::string refuse_density(const Frame& frame, const MicroscopeSetup& setup);

/// The iterations of `dfsph` for the pressures of a fluid in the last sub-step of the coming tick:
/// the mean error of the density, and that of each particle. A copy of the world is stepped.
Result<MicroscopeRecording> record_density(const World& world, const MicroscopeSetup& setup);

}  // namespace tumble
