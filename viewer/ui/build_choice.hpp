#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/mesh_source.hpp"
#include "engine/dynamics/joints/joint_kinds.hpp"

#include <string>
#include <variant>

namespace tumble {

/// A body with one shape of all_shapes().
struct NewBody {
  size_t shape = 0;
  friend bool operator==(const NewBody&, const NewBody&) = default;
};
struct NewJoint {
  JointKind kind = JointKind::revolute;
  bool motor = false;  ///< the joint gets a motor along its free coordinate
  friend bool operator==(const NewJoint&, const NewJoint&) = default;
};
/// A body with a mesh loaded from a file.
struct NewMesh {
  std::string file;
  MeshMode mode = MeshMode::triangle_mesh;
  friend bool operator==(const NewMesh&, const NewMesh&) = default;
};
struct NewSpring {
  friend bool operator==(const NewSpring&, const NewSpring&) = default;
};
/// Parts of a scene other than bodies and joints.
enum class PartKind : uint8_t { emitter, cloth, net, heap, fluid, gate, region };
struct NewPart {
  PartKind kind = PartKind::emitter;
  friend bool operator==(const NewPart&, const NewPart&) = default;
};

/// What a click on the picture creates.
struct BuildChoice {
  std::variant<NewBody, NewJoint, NewSpring, NewPart, NewMesh> what;
  std::string mesh_file;  ///< mesh file loaded into the palette; "": none
  MeshMode mesh_mode = MeshMode::convex_hull;
  size_t material = 0;  ///< index into built_in_materials()
  BodyType type = BodyType::dynamic;
};

}  // namespace tumble
