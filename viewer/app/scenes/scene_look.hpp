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

/// A camera of a scene, perhaps moving along with a body.
struct ViewPoint {
  std::string name;
  Camera camera;                 ///< as at tick 0
  BodyId follow;                 ///< null: stands still
  Vec3 follow_x = Vec3::Zero();  ///< where that body was at tick 0 [m]
  std::vector<CameraKey> path;   ///< its flight; empty: none

  /// The camera for a moment between two frames.
  Camera at(const Frame& from, const Frame& to, double s) const;
};

/// What a person wants to see first: everything that moves, where it can fall, and what is about
/// it, but no wall, floor or landscape that would make it small, and nothing that has flown away
/// (bounds_of_most), or has left `home`, where the scene began; everything finite when nothing
/// moves.
Aabb interesting_bounds(const Frame& frame, const std::optional<Aabb>& home = {});

/// The camera of this name; the scene's first one for an empty name; one that sees everything when
/// the scene has none. The error of an unknown name lists those there are.
Result<ViewPoint> find_view_point(const BuiltScene& scene, std::string_view name, double aspect);

/// Labels and hierarchies that bodies of the scene want shown.
std::vector<BodyNote> body_notes(const BuiltScene& scene);

/// Overlays that the scene wants to be on.
Overlays overlays_of(const SceneDescription& description);

/// Sun, sky, ground and exposure of the scene.
void apply_look(const SceneDescription& description, RenderScene& out);

}  // namespace tumble
