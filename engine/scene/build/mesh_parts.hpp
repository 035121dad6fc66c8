#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <span>
#include <string>
#include <vector>

namespace tumble {

/// A shape that stands for a mesh or for a part of it.
struct MeshPart {
  ShapeDef shape;
  Pose pose;          ///< in the mesh's frame
  double filled = 1;  ///< the volume of what it stands for over its own
};

/// The shapes of a mesh that collides in some way.
struct MeshParts {
  MeshRepresentation how;  ///< with the values that were taken where none were asked for
  std::vector<MeshPart> parts;
  std::string note;  ///< what is approximate about them and by how much; "": nothing
};

/// From the caches, or made anew. Errors: a mesh that is not closed has no pieces and no field; a
/// flat one has no hull, pieces or primitive; cancelled (engine/core/stop.hpp).
Result<MeshParts> mesh_parts(const std::shared_ptr<const TriangleMesh>& mesh,
                             const MeshRepresentation& how);

/// What is approximate about the hull of a mesh in its place, and by how much: how far it reaches
/// outside, and what that does to the mass. "" where the mesh is convex, or has no hull.
std::string hull_note(const std::shared_ptr<const TriangleMesh>& mesh);

/// Appends the shapes that stand for a mesh: `whole` has its pose in the body frame and its
/// material.
void append_mesh_parts(std::vector<BodyShapeDef>& shapes, const BodyShapeDef& whole,
                       const std::shared_ptr<const TriangleMesh>& mesh, const MeshParts& parts);

/// Shapes of a body that belong together: those that stand for one mesh, or a single one. As many
/// as the scene file has shapes of the body.
struct ShapeGroup {
  size_t first = 0, count = 1;
};
std::vector<ShapeGroup> shape_groups(const BodyDef& def);

/// The mesh of a group that may collide in other ways too; nothing where there is none.
std::shared_ptr<const MeshSource> source_of(const BodyDef& def, const ShapeGroup& group);

/// Puts other shapes for the same mesh in the place of a group, with the material of its first
/// shape. Nothing changes where the group has no mesh.
void replace_group(BodyDef& def, size_t group, const MeshParts& parts);

}  // namespace tumble
