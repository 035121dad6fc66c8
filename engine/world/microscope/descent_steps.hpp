#pragma once
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// Why the two shapes are refused; "" when both have triangles and at least one is a mesh.
std::string refuse_descent(const Shape& a, const Shape& b);

/// The simultaneous descent of two trees of bounding volumes to the pairs of near triangles, one
/// step a level: which pairs of nodes are tested, and which of them are pruned.
MicroscopeRecording record_aabb_descent(const MicroscopeSlide& slide);
MicroscopeRecording record_obb_descent(const MicroscopeSlide& slide);
MicroscopeRecording record_sphere_descent(const MicroscopeSlide& slide);

}  // namespace tumble
