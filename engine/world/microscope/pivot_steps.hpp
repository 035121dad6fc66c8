#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why there are no contact forces to be sought around the setup's body A, "" when there are.
std::string refuse_pivots(const Frame& frame, const MicroscopeSetup& setup);

/// The forces of all contacts of a body and of what touches it, sought by pivoting: a step for each
/// stop of an unknown that is driven. Dantzig's without friction, Baraff's with it. The problem is
/// the one that the event stepper poses at this moment; under another stepper, that of the end of
/// the coming tick if the event stepper took it.
Result<MicroscopeRecording> record_dantzig(const World& world, const MicroscopeSetup& setup);
Result<MicroscopeRecording> record_baraff(const World& world, const MicroscopeSetup& setup);

}  // namespace tumble
