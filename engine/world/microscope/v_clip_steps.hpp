#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// "" when both shapes are boxes or convex hulls with Voronoi planes.
std::string refuse_v_clip(const Shape& a, const Shape& b);

/// V-Clip's walk, one step a pair of features, each with the test that names the next pair.
MicroscopeRecording record_v_clip(const MicroscopeSlide& slide);

}  // namespace tumble
