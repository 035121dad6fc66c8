#pragma once
#include "engine/collision/manifold_builder.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// Projects two supporting faces along `normal` (unit, from A to B) and adds the corners of their
/// common area as contact points: corners of one over the other, and crossings of sides. Gaps are
/// measured along the normal between the two planes, less `rounding` (both shapes' together);
/// points with gap > margin are left out. Points, segments and polygons in any pairing; a pair
/// with a point, or two segments that are not parallel, adds nothing (the closest points do).
/// `shift` is the share of the rounding on A's side, to place points midway.
void clip_faces(const SupportingFace& a, const SupportingFace& b, const Vec3& normal,
                double rounding_a, double rounding_b, double margin, ManifoldBuilder& out);

}  // namespace tumble
