#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/forces/spring.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "viewer/app/editing/scene_saver.hpp"

#include <span>
#include <vector>

namespace tumble {

class World;

/// Bodies with the joints and springs between them, and joints that hold them to the world: what is
/// copied. Depends on no world, so that it may come into another one.
struct CopiedBodies {
  /// One of `bodies`, or none: the world.
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

/// The bodies as they are now; those that are gone are left out.
CopiedBodies take_copies(const World& world, std::span<const BodyId> bodies);

/// Copies of the group into a world, displaced by `way` (world axes: x -> way.point(x)), with names
/// of their own, awake. What that changes about the scene's file is noted in `edits`: where the
/// originals are `of_this_scene`, the file names their meshes. Error: a body that cannot be made;
/// those before it are there.
Result<std::vector<BodyId>> add_copies(World& world, const CopiedBodies& group, const Pose& way,
                                       std::vector<SceneEdit>& edits, bool of_this_scene);

}  // namespace tumble
