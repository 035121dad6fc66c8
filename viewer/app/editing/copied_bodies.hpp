#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/forces/spring.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "viewer/app/editing/scene_saver.hpp"

#include <span>
#include <vector>

namespace tumble {

class World;

/// Copied bodies, with the joints and springs between them and joints that attach them to the
/// world. Independent of any world, so that they can be added to another one.
struct CopiedBodies {
  /// An index into `bodies`; none: the world.
  using End = std::optional<size_t>;
  struct Joint {
    JointDef def;
    End a, b;
  };
  struct Spring {
    SpringDef def;
    End a, b;
  };
  std::vector<BodyDef> bodies;
  std::vector<Joint> joints;
  std::vector<Spring> springs;

  bool empty() const { return bodies.empty(); }
};

/// Copies bodies in their present state; those that no longer exist are left out.
CopiedBodies take_copies(const World& world, std::span<const BodyId> bodies);

/// Adds copies of the group to a world, displaced by `way` (world axes: x -> way.point(x)), with
/// new names, awake. Changes to the scene's file are recorded in `edits`; if the originals are
/// `of_this_scene`, meshes are referred to by their names in the file. Error: a body that cannot be
/// created; those before it remain.
Result<std::vector<BodyId>> add_copies(World& world, const CopiedBodies& group, const Pose& way,
                                       std::vector<SceneEdit>& edits, bool of_this_scene);

}  // namespace tumble
