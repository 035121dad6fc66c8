#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// "" when the setup's body A is there and moves by forces.
std::string refuse_first_event(const Frame& frame, const MicroscopeSetup& setup);

/// The event stepper's search for the first event of a body's group, in the first tick from now on
/// that has one (looked ahead over the span): the times that are tried, the signs of what is
/// watched, and the bracket about the first zero. A copy of the world is stepped; under another
/// stepper than `event` it goes on by that.
Result<MicroscopeRecording> record_first_event(const World& world, const MicroscopeSetup& setup);

}  // namespace tumble
