#pragma once
#include "engine/geometry/triangle_mesh.hpp"

namespace tumble {

struct OrientationReport {
  size_t flipped_triangles = 0;   ///< turned to agree with their neighbours
  size_t flipped_parts = 0;       ///< closed parts turned whole, because they were inside-out
  size_t unorientable_parts = 0;  ///< left as they were

  std::vector<uint32_t> flipped;       ///< the triangles turned to agree, ascending
  std::vector<uint32_t> turned_parts;  ///< the first triangle of each part turned whole
  std::vector<uint32_t> unorientable;  ///< the first triangle of each part left
};

/// Turns triangles so that any two that share a manifold edge run along it in opposite directions,
/// starting in each connected part from the orientation that most of its triangles have. Closed
/// parts are then turned outwards, except that a part that came inside-out and lies within the
/// bounds of a larger closed part (one of the 256 largest) is taken for a cavity and left so.
OrientationReport orient_consistently(TriangleMesh& mesh);

}  // namespace tumble
