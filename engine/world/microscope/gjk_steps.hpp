#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why the two shapes are refused; "" when both are convex.
std::string refuse_gjk(const Shape& a, const Shape& b);

/// GJK's iterations towards the origin in the difference A - B, two steps each (the support point
/// is computed; the simplex is updated with it), and where the bodies overlap the growth of EPA's
/// polytope. Each step calls gjk() with a limit on its iterations, so that no algorithm is written
/// twice.
MicroscopeRecording record_gjk(const MicroscopeSlide& slide);

}  // namespace tumble
