#pragma once
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

#include <vector>

namespace tumble {

/// Contacts, within `margin`, of the active corners of a field's mesh with a convex solid at
/// `pose`, in the frame of the mesh: a corner may touch a face of the solid far from all of the
/// solid's corners. Normals point out of the solid; keys are those of the mesh's corners.
void corners_in_convex(const PlacedSurface& corners, const ConvexShape& solid, const Pose& pose,
                       double margin, std::vector<FeatureContact>& contacts);

/// The same with a mesh that has no field, by the faces near each corner (mesh_pairs).
void corners_on_mesh(const PlacedSurface& corners, const PlacedSurface& mesh, double margin,
                     std::vector<FeatureContact>& contacts);

}  // namespace tumble
