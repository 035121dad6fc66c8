#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why the two shapes are refused; "" when both are convex, or one is and the other a half-space.
std::string refuse_contact_time(const Shape& a, const Shape& b);

/// Conservative advancement of the two bodies along their motions: each distance query with the
/// bodies at that time, the rest of the interval, and the step that the distance allows.
MicroscopeRecording record_contact_time(const MicroscopeSlide& slide);

}  // namespace tumble
