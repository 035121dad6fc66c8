#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/contact/contact.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The shapes of one side of a pair: all of a body, or one.
struct SideShapes {
  const RigidBody& body;
  std::span<const BodyShape> shapes;
  uint32_t first = 0;                ///< the place of the first of them in RigidBody::shapes
  const BoundsTree* tree = nullptr;  ///< over several, else null
};
/// Of the body as a whole, or of one of its shapes.
SideShapes side_shapes(const RigidBody& body, uint32_t shape);

/// Two shapes, and how far the balls about them are apart at least [m].
struct ShapesNear {
  ShapesOfPair shapes;
  double apart = 0;
};

/// Replaces `out` by all pairs of shapes of two sides whose bounds are within `reach` of each
/// other [m], and few others, in order. By the trees of bodies of several shapes: the shapes of the
/// side that has fewer near the bounds of the other, then of the other those near each of these.
/// Gives how far all others are apart at least: `reach`, or more where there are none near.
double find_shape_pairs(const SideShapes& a, const SideShapes& b, double reach,
                        std::vector<ShapesNear>& out);

}  // namespace tumble
