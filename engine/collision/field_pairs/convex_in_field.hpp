#pragma once
#include "engine/collision/field_pairs/field_sample.hpp"
#include "engine/collision/mesh_pairs/patches.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

#include <vector>

namespace tumble {

/// The nearest point of a convex solid's surface, by its closed form or else by GJK; all in the
/// shape's frame.
SurfacePoint nearest_of(const ConvexShape& shape, const Vec3& p);

/// Contacts of a round convex shape with a field, in the field's frame, in which the shape stands
/// at `pose`: the deepest point of the shape's solid and other local minima of the field over it
/// that are within `margin`, with the corners of the face that the shape shows there. Normals point
/// out of the field. Returns a bound that the two are sure to be apart [m], at most `margin` where
/// anything may be near.
///
/// Branch and bound (Lipschitz: Piyavskii 1972, with local searches as in Horst and Tuy, "Global
/// optimization", 1996) over cubes of the space about the shape, cut in eight. A distance changes
/// by no more than one goes, so a cube is left out where its part of the solid cannot be within the
/// margin, and, from a size on that is a part of the shape's, where it cannot be deeper than what
/// has been found by more than tolerances::deepest. Every cube of that size, and smaller ones that
/// are deeper than anything found, start a walk against the gradient and back to the nearest point
/// of the solid (projected gradients, Bertsekas 1976), first all the way to the supporting point as
/// Macklin et al. 2020 do, then by shorter steps where that leads up. Depths are those that the
/// field gives; it errs by what DistanceSample::error says.
double convex_in_field(const ConvexShape& shape, const Pose& pose, const DistanceField& field,
                       double margin, std::vector<FeatureContact>& contacts);

}  // namespace tumble
