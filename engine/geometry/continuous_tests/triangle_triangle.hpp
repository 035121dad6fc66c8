#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/continuous_tests/moving.hpp"

#include <cstdint>
#include <optional>

namespace tumble {

/// Which features of two triangles meet.
enum class MovingFeatures : uint8_t {
  vertex_face,  ///< corner `a` of A on B
  face_vertex,  ///< corner `b` of B on A
  edge_edge,    ///< side `a` of A on side `b` of B; side k runs from corner k to k + 1
  overlap,      ///< the triangles cross each other at t = 0 already
};

struct MovingTriangleContact : MovingContact {
  MovingFeatures features = MovingFeatures::overlap;
  uint8_t a = 0, b = 0;
};

/// When two moving triangles first come within `separation` >= 0 [m] of each other (Coutinho 2013
/// §2.5.15): the first of six vertex-face and nine edge-edge contacts, unless they overlap at t =
/// 0, which is decided exactly. Guarantees and refusals of `vertex_face_contact`.
Result<std::optional<MovingTriangleContact>> moving_triangles_contact(const MovingTriangle& a,
                                                                      const MovingTriangle& b,
                                                                      double separation = 0);

}  // namespace tumble
