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
/// at `pose`: every local minimum of the field over the shape's solid that is within `margin`, with
/// the corners of the face that the shape shows it. Normals point out of the field. Returns a bound
/// that the two are sure to be apart [m], at most `margin` where anything may be near.
///
/// The search descends from every cube of space that holds points of the shape and may hold such
/// of the field, so that what it finds depends on no guess; a cube is left out only where the field
/// at its middle, less its error and the cube's reach, is above the margin. Each descent walks
/// against the gradient and back to the nearest point of the solid (projected gradients, Bertsekas
/// 1976), first all the way to the supporting point as Macklin et al. 2020 do, then by shorter
/// steps where that leads up.
double convex_in_field(const ConvexShape& shape, const Pose& pose, const DistanceField& field,
                       double margin, std::vector<FeatureContact>& contacts);

}  // namespace tumble
