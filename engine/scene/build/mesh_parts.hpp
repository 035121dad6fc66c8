#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <span>
#include <string>
#include <vector>

namespace tumble {

/// A shape that approximates a mesh or a part of it.
struct MeshPart {
  ShapeDef shape;
  Pose pose;          ///< in the mesh's frame
  double filled = 1;  ///< volume of the solid that it approximates over its own volume [-]
};

/// The collision shapes of a mesh in one of its modes.
struct MeshParts {
  MeshRepresentation how;  ///< with default values filled in
  std::vector<MeshPart> parts;
  std::string note;  ///< what is approximate about them, and the error; "": nothing
};

/// From the caches, or computed. Errors: a mesh that is not closed has no pieces and no field; a
/// flat one has no hull, pieces or primitive; cancelled (engine/core/stop.hpp).
Result<MeshParts> mesh_parts(const std::shared_ptr<const TriangleMesh>& mesh,
                             const MeshRepresentation& how);

/// Note on the error of the hull of a mesh in its place: how far it extends beyond the mesh, and
/// the effect on the mass. "" if the mesh is convex, or has no hull.
std::string hull_note(const std::shared_ptr<const TriangleMesh>& mesh);

/// Appends the collision shapes of a mesh; `whole` has its pose in the body frame and its material.
void append_mesh_parts(std::vector<BodyShapeDef>& shapes, const BodyShapeDef& whole,
                       const std::shared_ptr<const TriangleMesh>& mesh, const MeshParts& parts);

/// Shapes of a body that belong together: those that approximate one mesh, or a single shape. A
/// body has as many groups as the scene file has shapes of it.
struct ShapeGroup {
  size_t first = 0, count = 1;
};
std::vector<ShapeGroup> shape_groups(const BodyDef& def);

/// The mesh of a group that may also collide in other modes; null if there is none.
std::shared_ptr<const MeshSource> source_of(const BodyDef& def, const ShapeGroup& group);

/// Replaces a group by other shapes for the same mesh, with the material of its first shape. No
/// change if the group has no mesh.
void replace_group(BodyDef& def, size_t group, const MeshParts& parts);

}  // namespace tumble
