#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/continuous_tests/moving.hpp"

#include <optional>

namespace tumble {

/// When two moving edges first come within `separation` >= 0 [m] of each other, ends included;
/// nothing when they never do. Method, guarantees and refusals are those of `vertex_face_contact`;
/// parallel edges and edges of no length are no exceptions.
Result<std::optional<MovingContact>> edge_edge_contact(const MovingEdge& a, const MovingEdge& b,
                                                       double separation = 0);

}  // namespace tumble
