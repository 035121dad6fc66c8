#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why the setup is refused; "" when its body A exists and is dynamic.
std::string refuse_first_event(const Frame& frame, const MicroscopeSetup& setup);

/// The event stepper's search for the first event of a body's group, in the first tick from now on
/// that has one (up to the setup's span): the times that are tried, the signs of the monitored
/// functions, and the bracket about the first zero. A copy of the world is stepped; if the world
/// has another stepper than `event`, the copy is switched to that.
Result<MicroscopeRecording> record_first_event(const World& world, const MicroscopeSetup& setup);

}  // namespace tumble
