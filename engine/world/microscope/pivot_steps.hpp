#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why there is no problem of contact forces around the setup's body A, "" when there is one.
std::string refuse_pivots(const Frame& frame, const MicroscopeSetup& setup);

/// The forces of all contacts of a body's group, found by pivoting: one step for each time that the
/// driven unknown stops. Dantzig's method without friction, Baraff's with it. The problem is the
/// one that the event stepper poses at this moment; under another stepper, the one at the end of
/// the coming tick if the event stepper took it.
Result<MicroscopeRecording> record_dantzig(const World& world, const MicroscopeSetup& setup);
Result<MicroscopeRecording> record_baraff(const World& world, const MicroscopeSetup& setup);

}  // namespace tumble
