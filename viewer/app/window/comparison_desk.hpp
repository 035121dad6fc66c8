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

/// World B beside the one that is shown, for panels and pictures.
class ComparisonDesk {
 public:
  /// B is what A is from now on, or `made`, at its first tick. `trail`: how long paths of bodies
  /// are [s].
  void begin(Session& session, WorldChoice choice, double trail, const World* made = nullptr);
  /// B is to be opened beside the one that is shown, as this wish says. What is there stays until
  /// then.
  void open(SceneOpener open, SceneWish wish, WorldChoice choice);
  /// What has been opened, once, and how it was chosen.
  struct Opened {
    WorldChoice choice;
    Result<OpenedScene> scene;
  };
  std::optional<Opened> take_opened();
  void end(Session& session);
  /// Another world is shown; the session has let go of B.
  void forget();
  /// A was put to a later moment, and B with it: nobody has seen the way.
  void restart_trail() { trails_.start(trail_); }
  /// Looks at B as it is now. `shown`: of A, and how that was chosen.
  void update(const Frame& shown, const WorldChoice& of_a);
  /// Null: there is no world B, and none is being opened.
  const WorldComparison* comparison() const { return second_ || opening_ ? &comparison_ : nullptr; }
  /// Adds B's bodies and particles to the picture of A, as one sees through.
  void draw_ghost(const SessionView& shown, const ExtractOptions& options, ShapeMeshes& meshes,
                  RenderScene& picture);
  /// A picture of B alone, seen as that of A is. What lies under the microscope is A's.
  RenderScene& draw_beside(const SessionView& shown, const ExtractOptions& options,
                           ShapeMeshes& meshes, const RenderScene& picture);
  const RenderScene& picture() const { return picture_; }
  void look_from(const Camera& camera) { picture_.camera = camera; }
  /// The moment of B that is shown beside this one of A; none: B has not been seen yet.
  std::optional<SessionView> view(const SessionView& shown) const;

 private:
  std::shared_ptr<SecondWorld> second_;
  std::unique_ptr<SceneLoader> opening_;  ///< null: none is being opened
  WorldChoice wanted_;                    ///< of that
  SecondWorld::Shown seen_;
  WorldComparison comparison_;
  RenderScene picture_;  ///< of B, kept for its memory
  Trails trails_;
  double trail_ = 0;  ///< how long they are [s]
};

}  // namespace tumble
