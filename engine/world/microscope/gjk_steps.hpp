#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// "" when both shapes are convex.
std::string refuse_gjk(const Shape& a, const Shape& b);

/// GJK as it closes in on the origin of the difference A - B, two steps an iteration (the support
/// is looked for; the simplex takes it in), and where the bodies overlap EPA growing its polytope.
/// Each step is gjk() stopped after so many iterations, so nothing is done twice in code.
MicroscopeRecording record_gjk(const MicroscopeSlide& slide);

}  // namespace tumble
