#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why the two shapes are refused; "" when both are boxes or convex hulls with Voronoi planes.
std::string refuse_v_clip(const Shape& a, const Shape& b);

/// V-Clip's walk, one step for each pair of features, with the test that determines the next pair.
MicroscopeRecording record_v_clip(const MicroscopeSlide& slide);

}  // namespace tumble
