#pragma once
#include "engine/core/result.hpp"
#include "viewer/app/scenes/camera_path.hpp"
#include "viewer/render/extract.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct BuiltScene;
struct SceneDescription;

/// A camera of a scene, which may follow a body or a path.
struct ViewPoint {
  std::string name;
  Camera camera;                 ///< as at tick 0
  BodyId follow;                 ///< body to follow; null: none
  Vec3 follow_x = Vec3::Zero();  ///< position of that body at tick 0 [m]
  std::vector<CameraKey> path;   ///< keys of its path; empty: none

  /// The camera for a moment between two frames.
  Camera at(const Frame& from, const Frame& to, double s) const;
};

/// Bounds of what a viewer is first interested in: everything that moves, where it can fall, and
/// what is around it, but no wall, floor or landscape so large that the rest would look small, and
/// nothing that has flown away (bounds_of_most) or has left `home`, the bounds at the start. If
/// nothing moves, everything that is finite.
Aabb interesting_bounds(const Frame& frame, const std::optional<Aabb>& home = {});

/// The camera of this name; for an empty name the scene's first camera, or one that sees everything
/// if it has none. The error for an unknown name lists the known ones.
Result<ViewPoint> find_view_point(const BuiltScene& scene, std::string_view name, double aspect);

/// The labels and hierarchies that the scene wants shown on its bodies.
std::vector<BodyNote> body_notes(const BuiltScene& scene);

/// The overlays that the scene wants.
Overlays overlays_of(const SceneDescription& description);

/// Applies the sun, sky, ground and exposure of the scene.
void apply_look(const SceneDescription& description, RenderScene& out);

}  // namespace tumble
