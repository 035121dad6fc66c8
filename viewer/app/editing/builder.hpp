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

/// What was added to the world.
struct Added {
  SceneEdit edit;  ///< what it changes about the scene's file
  BodyId body;     ///< null where it is no body
};

/// What a click adds to the world.
struct Addition {
  std::string what;  ///< the deed, as undo names it
  std::function<Result<Added>(World&)> make;
};

/// Puts new bodies, joints and springs where a person clicks. A body takes one click, on what it is
/// to stand on; a joint or spring two: the first says which body and where the anchor and the main
/// axis are (across the surface), the second which other body, or none for the world.
class Builder {
 public:
  /// Of new things that are looked at from this far [m].
  static double usual_size(double view);
  /// `view` [m]: how far away the picture is looked at, where nothing was hit.
  std::optional<Addition> click(const BuildChoice& choice, const Frame& frame, const Ray& ray,
                                const std::optional<Pick>& hit, double view);
  /// The same of a mesh file.
  static Addition mesh_body(const BuildChoice& choice, const PaletteMesh& mesh, const Vec3& at,
                            const Vec3& normal);
  /// The first end is known, the second awaited.
  bool half_way() const { return first_.has_value(); }
  /// Forgets the first end.
  void cancel() { first_.reset(); }
  /// Shows the first end: its anchor, and the axis where the joint has one.
  void draw(const BuildChoice& choice, const Frame& frame, RenderScene& picture) const;

 private:
  Addition body(const BuildChoice& choice, const Vec3& at, const Vec3& normal, double view) const;
  std::optional<Addition> connection(const BuildChoice& choice, const Frame& frame,
                                     const std::optional<Pick>& hit, const Vec3& at) const;

  struct End {
    BodyId body;
    Pose frame_body;  ///< anchor, z along the normal; in the definition's body frame
  };
  std::optional<End> first_;
};

}  // namespace tumble
