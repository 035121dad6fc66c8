#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/mesh_source.hpp"
#include "engine/dynamics/joints/joint_kinds.hpp"

#include <string>
#include <variant>

namespace tumble {

/// A body of one of all_shapes().
struct NewBody {
  size_t shape = 0;
  friend bool operator==(const NewBody&, const NewBody&) = default;
};
struct NewJoint {
  JointKind kind = JointKind::revolute;
  bool motor = false;  ///< that turns it, or drives it along
  friend bool operator==(const NewJoint&, const NewJoint&) = default;
};
/// A mesh file, from the root.
struct NewMesh {
  std::string file;
  MeshMode mode = MeshMode::triangle_mesh;
  friend bool operator==(const NewMesh&, const NewMesh&) = default;
};
struct NewSpring {
  friend bool operator==(const NewSpring&, const NewSpring&) = default;
};
/// What is neither body nor joint.
enum class PartKind : uint8_t { emitter, cloth, net, heap, fluid, gate, region };
struct NewPart {
  PartKind kind = PartKind::emitter;
  friend bool operator==(const NewPart&, const NewPart&) = default;
};

/// What clicks on the picture build.
struct BuildChoice {
  std::variant<NewBody, NewJoint, NewSpring, NewPart, NewMesh> what;
  std::string mesh_file;  ///< that is in the palette; "": none yet
  MeshMode mesh_mode = MeshMode::convex_hull;
  size_t material = 0;  ///< of built_in_materials()
  BodyType type = BodyType::dynamic;
};

}  // namespace tumble
