#pragma once
#include "engine/geometry/hierarchy/triangle_decisions.hpp"

namespace tumble {

/// A triangle of a surface with the numbers of its corners.
struct NumberedTriangle {
  Triangle id;
  TriangleCorners at;
};

/// Two triangles of a surface have more in common than the corners and sides that they share,
/// exactly for the doubles given.
bool clash(const NumberedTriangle& a, const NumberedTriangle& b);

}  // namespace tumble
