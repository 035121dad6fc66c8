#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

#include <vector>

namespace tumble {

/// Contacts of the active corners of a field's mesh, at rest in the frame, with a convex solid at
/// `pose`, within `margin`: its corners may touch a face of the solid far from all corners of that.
/// Normals point out of the solid; keys are those of corners.
void corners_in_convex(const PlacedSurface& corners, const ConvexShape& solid, const Pose& pose,
                       double margin, std::vector<FeatureContact>& contacts);

/// The same with a mesh that has no field: by the faces near each corner (mesh_pairs).
void corners_on_mesh(const PlacedSurface& corners, const PlacedSurface& mesh, double margin,
                     std::vector<FeatureContact>& contacts);

}  // namespace tumble
