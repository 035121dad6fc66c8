#pragma once
#include "engine/collision/manifold_builder.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

namespace tumble {

/// Projects two supporting faces along `normal` (unit, from A to B) and adds the corners of their
/// common area as contact points: corners of one over the other, and crossings of sides. Gaps are
/// measured along the normal between the two planes, less both radii of rounding; points with gap >
/// margin are left out. Accepts points, segments and polygons in any pairing; a pair with a point,
/// or two segments that are not parallel, adds nothing (the closest points suffice). Points lie
/// midway between the two rounded surfaces.
void clip_faces(const SupportingFace& a, const SupportingFace& b, const Vec3& normal,
                double rounding_a, double rounding_b, double margin, ManifoldBuilder& out);

}  // namespace tumble
