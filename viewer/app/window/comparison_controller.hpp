#pragma once
#include "viewer/app/session/second_world.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/app/window/scene_loader.hpp"
#include "viewer/render/render_scene.hpp"
#include "viewer/render/trails.hpp"
#include "viewer/ui/comparison.hpp"

#include <memory>
#include <optional>

namespace tumble {

struct ExtractOptions;
class ShapeMeshes;

/// Manages world B of a comparison for panels and pictures.
class ComparisonController {
 public:
  /// Starts world B as a copy of A's present state, or as `made`, a world at its first tick.
  /// `trail`: length of the paths of bodies [s].
  void begin(Session& session, WorldChoice choice, double trail, const World* made = nullptr);
  /// Opens world B from a scene in the background, as this request says. The present B stays until
  /// then.
  void open(SceneOpener open, OpenRequest wanted, WorldChoice choice);
  /// A scene that was opened, and the choice for B; returned once.
  struct Opened {
    WorldChoice choice;
    Result<OpenedScene> scene;
  };
  std::optional<Opened> take_opened();
  void end(Session& session);
  /// To be called when another world is shown; the session has dropped B.
  void forget();
  /// To be called when both worlds were set to a later moment, without the frames between.
  void restart_trail() { trails_.start(trail_); }
  /// Sets another length of the trails [s].
  void set_trail(double seconds) {
    if (seconds == trail_) return;
    trail_ = seconds;
    restart_trail();
  }
  /// Reads B's present state. `shown`: frame of A; `of_a`: A's choices.
  void update(const Frame& shown, const WorldChoice& of_a);
  /// Null: there is no world B, and none is being opened.
  const WorldComparison* comparison() const { return second_ || opening_ ? &comparison_ : nullptr; }
  /// Adds B's bodies and particles transparently to the picture of A.
  void draw_ghost(const SessionView& shown, const ExtractOptions& options, ShapeMeshes& meshes,
                  RenderScene& picture);
  /// A picture of B with A's camera and look. The microscope shows what it shows of A.
  RenderScene& draw_beside(const SessionView& shown, const ExtractOptions& options,
                           ShapeMeshes& meshes, const RenderScene& picture);
  const RenderScene& picture() const { return picture_; }
  void look_from(const Camera& camera) { picture_.camera = camera; }
  /// B's moment that corresponds to this one of A; empty: none has been seen yet.
  std::optional<SessionView> view(const SessionView& shown) const;

 private:
  std::shared_ptr<SecondWorld> second_;
  std::unique_ptr<SceneLoader> opening_;  ///< null: none is being opened
  WorldChoice wanted_;                    ///< choice for the world being opened
  SecondWorld::Shown seen_;
  WorldComparison comparison_;
  RenderScene picture_;  ///< of B; kept to reuse its memory
  Trails trails_;
  double trail_ = 0;  ///< length of the trails [s]
};

}  // namespace tumble
