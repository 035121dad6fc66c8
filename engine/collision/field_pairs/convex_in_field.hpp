#pragma once
#include "engine/collision/field_pairs/field_sample.hpp"
#include "engine/collision/mesh_pairs/patches.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

#include <vector>

namespace tumble {

/// The point of a convex solid's surface nearest to p, by its closed form or else by GJK; all in
/// the shape's frame.
SurfacePoint nearest_of(const ConvexShape& shape, const Vec3& p);

/// Contacts of a round convex shape with a field, in the field's frame, in which the shape has the
/// given `pose`: the deepest point of the solid and other local minima of the field over it that
/// are within `margin`, with the corners of the face that the shape has there. Normals point out of
/// the field. Returns a lower bound on the distance of the two [m], at most `margin` if anything
/// may be near.
///
/// Branch and bound (Lipschitz: Piyavskii 1972, with local searches as in Horst and Tuy, "Global
/// optimization", 1996) over cubes of the space about the shape, each divided into eight. A
/// distance function has Lipschitz constant 1, so a cube is discarded if its part of the solid
/// cannot be within the margin, and, below a size relative to the shape's, if it cannot be deeper
/// than the deepest point found by more than tolerances::deepest. Every cube of that size, and
/// smaller ones that are deeper than anything found, start a descent along the gradient with
/// projection to the nearest point of the solid (projected gradients, Bertsekas 1976), first all
/// the way to the supporting point as Macklin et al. 2020 do, then by shorter steps where that
/// would ascend. Depths are those of the field, whose error is DistanceSample::error.
double convex_in_field(const ConvexShape& shape, const Pose& pose, const DistanceField& field,
                       double margin, std::vector<FeatureContact>& contacts);

}  // namespace tumble
