#pragma once
#include "engine/world/frame.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/refusal.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/handles.hpp"
#include "viewer/interact/picking.hpp"
#include "viewer/interact/selection.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

struct RenderScene;

/// Moves, turns and scales the selected bodies: by handles that stand at the main one, or by
/// dragging one of them over what is there, so that it stands on the face under the pointer.
class Arranger {
 public:
  /// Where handles stand: at the main body's centre of mass. Nothing without a selection.
  static std::optional<Pose> frame_of(const Frame& shown, const Selection& selection,
                                      const HandleSettings& settings);

  /// A drag begins at a point of the picture: on a handle, or on the body itself.
  void begin(const Frame& shown, const Selection& selection, const HandleSettings& settings,
             const Handles::View& view, double x, double y);
  bool active() const { return active_; }
  /// Where the pointer asks the bodies to be. `hit`: what is under it that is not being moved.
  std::optional<Displacement> drag(const HandleSettings& settings, const Handles::View& view,
                                   double x, double y, bool snap, const std::optional<Pick>& hit);
  /// Where it asked them to be last.
  const std::optional<Displacement>& last() const { return last_; }
  std::span<const BodyId> bodies() const { return bodies_; }
  void end();

  /// Puts the bodies where `way` asks, from where they were when the deed began; what that changes
  /// about the scene's file is noted in `edits`. In a world that runs they stand still while held.
  void apply(Session& session, const Displacement& way, DeedEdits edits, Refusal refusal) const;
  /// The same in one go, for numbers that were typed.
  static void apply_once(Session& session, const Selection& selection, const Displacement& way,
                         DeedEdits edits, Refusal refusal);

  /// The handles at the selected bodies, that under the pointer lit.
  void draw(const Frame& shown, const Selection& selection, const HandleSettings& settings,
            const Handles::View& view, double x, double y, RenderScene& out) const;

 private:
  std::optional<Displacement> asked(const HandleSettings& settings, const Handles::View& view,
                                    double x, double y, bool snap,
                                    const std::optional<Pick>& hit) const;

  /// The bodies' definitions when the deed began; filled and read on the simulation thread.
  using Start = std::vector<std::pair<BodyId, BodyDef>>;

  Handles handles_;
  std::vector<BodyId> bodies_;
  std::shared_ptr<Start> start_;
  Pose frame_;
  Aabb bounds_;  ///< of the body that is dragged itself, about the frame's origin
  std::optional<Displacement> last_;
  bool active_ = false;
};

}  // namespace tumble
