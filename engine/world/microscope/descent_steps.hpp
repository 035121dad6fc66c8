#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// "" when both shapes have triangles, one of them those of a mesh.
std::string refuse_descent(const Shape& a, const Shape& b);

/// The way down two trees of bounding volumes to the triangles that are near each other, one step a
/// level: which pairs of nodes are tested, and which of them leave out all that is below.
MicroscopeRecording record_aabb_descent(const MicroscopeSlide& slide);
MicroscopeRecording record_obb_descent(const MicroscopeSlide& slide);
MicroscopeRecording record_sphere_descent(const MicroscopeSlide& slide);

}  // namespace tumble
