#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/contact/contact.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The shapes of one side of a pair: all shapes of a body, or a single one.
struct SideShapes {
  const RigidBody& body;
  std::span<const BodyShape> shapes;
  uint32_t first = 0;  ///< index of the first of them in RigidBody::shapes
  /// Over the shapes, if the body is paired as a whole; otherwise null.
  const BoundsTree* tree = nullptr;
};
/// All shapes of a body that is paired as a whole; otherwise the given one.
SideShapes side_shapes(const RigidBody& body, uint32_t shape);

/// Two shapes, and a lower bound on the distance between their bounding spheres [m].
struct ShapesNear {
  ShapesOfPair shapes;
  double apart = 0;
};

/// Replaces `out` by all pairs of shapes of two sides whose bounds are within `reach` of each other
/// [m], and few others, sorted. Uses the trees of bodies of several shapes: first the shapes of the
/// side with fewer shapes that are near the bounds of the other side, then for each of these the
/// near shapes of the other side. Returns a lower bound on the distance of all other pairs:
/// `reach`, or more where no pair is near.
double find_shape_pairs(const SideShapes& a, const SideShapes& b, double reach,
                        std::vector<ShapesNear>& out);

}  // namespace tumble
