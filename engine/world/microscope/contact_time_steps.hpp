#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// "" when both shapes are convex, or one is and the other a half-space.
std::string refuse_contact_time(const Shape& a, const Shape& b);

/// Conservative advancement of the two bodies over their motions: each distance query with the
/// bodies there, what is left of the interval, and the step that it allows.
MicroscopeRecording record_contact_time(const MicroscopeSlide& slide);

}  // namespace tumble
