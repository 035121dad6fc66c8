#pragma once
#include "engine/scene/saving/scene_edits.hpp"
#include "viewer/app/editing/mesh_palette.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/render/render_scene.hpp"
#include "viewer/ui/build_choice.hpp"

#include <functional>
#include <optional>
#include <string>

namespace tumble {

/// The result of adding something to the world.
struct Added {
  SceneEdit edit;  ///< the change to the scene's file
  BodyId body;     ///< null if it is not a body
};

/// Something to be added by a click.
struct Addition {
  std::string what;  ///< description for undo
  std::function<Result<Added>(World&)> make;
};

/// Places new bodies, joints and springs by clicks. A body takes one click on what it is to stand
/// on; a joint or spring takes two: the first gives a body, the anchor and the main axis (along the
/// surface normal), the second the other body, or none for the world.
class Builder {
 public:
  /// Default size of new things for a viewing distance [m].
  static double usual_size(double view);
  /// Handles a click. `view`: viewing distance, used if nothing was hit [m].
  std::optional<Addition> click(const BuildChoice& choice, const Frame& frame, const Ray& ray,
                                const std::optional<Pick>& hit, double view);
  /// The addition of a body with a mesh from a file.
  static Addition mesh_body(const BuildChoice& choice, const PaletteMesh& mesh, const Vec3& at,
                            const Vec3& normal);
  /// Whether the first end of a joint or spring is given.
  bool half_way() const { return first_.has_value(); }
  /// Drops the first end.
  void cancel() { first_.reset(); }
  /// Draws the first end: its anchor, and the axis if the joint has one.
  void draw(const BuildChoice& choice, const Frame& frame, RenderScene& picture) const;

 private:
  Addition body(const BuildChoice& choice, const Vec3& at, const Vec3& normal, double view) const;
  std::optional<Addition> connection(const BuildChoice& choice, const Frame& frame,
                                     const std::optional<Pick>& hit, const Vec3& at) const;

  struct End {
    BodyId body;
    Pose frame_body;  ///< anchor, z along the normal; in the frame of the body's definition
  };
  std::optional<End> first_;
};

}  // namespace tumble
