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
#include <tuple>
#include <vector>

namespace tumble {

struct RenderScene;

/// Moves, rotates and scales the selected bodies: by handles at the primary one, or by dragging one
/// of them over the scene, so that it stands on the face under the pointer.
class Arranger {
 public:
  /// The frame of the handles: at the primary body's centre of mass. Empty without a selection.
  static std::optional<Pose> frame_of(const Frame& shown, const Selection& selection,
                                      const HandleSettings& settings);

  /// Begins a drag at a point of the picture: on a handle, or on the body itself. A body that was
  /// not selected had no handles when it was pressed, so it is not for the point to decide.
  void begin(const Frame& shown, const Selection& selection, const HandleSettings& settings,
             const Handles::View& view, double x, double y, bool on_handle);
  bool active() const { return active_; }
  /// The displacement that corresponds to the pointer's place. `hit`: what is under it, apart from
  /// the bodies being moved.
  std::optional<Displacement> drag(const HandleSettings& settings, const Handles::View& view,
                                   double x, double y, bool snap, const std::optional<Pick>& hit);
  /// The last displacement; none: nothing has been displaced yet.
  const std::optional<Displacement>& last() const { return last_; }
  /// How far the primary body was from a point when the drag began [m].
  double distance_from(const Vec3& eye) const { return (frame_.x - eye).norm(); }
  std::span<const BodyId> bodies() const { return bodies_; }
  void end();

  /// Displaces the bodies by `way` relative to their definitions at the begin of the drag, and
  /// records the changes to the scene's file in `edits`. In a running simulation they are held at
  /// rest during the drag.
  void apply(Session& session, const Displacement& way, UndoStepEdits edits, Refusal refusal) const;
  /// The same in one step, for typed numbers.
  static void apply_once(Session& session, const Selection& selection, const Displacement& way,
                         UndoStepEdits edits, Refusal refusal);

  /// Draws the handles at the selected bodies, with the one under the pointer highlighted.
  void draw(const Frame& shown, const Selection& selection, const HandleSettings& settings,
            const Handles::View& view, double x, double y, RenderScene& out) const;

 private:
  std::optional<Displacement> asked(const HandleSettings& settings, const Handles::View& view,
                                    double x, double y, bool snap,
                                    const std::optional<Pick>& hit) const;

  /// The bodies' definitions and poses at the begin of the drag; filled and read on the simulation
  /// thread.
  using Start = std::vector<std::tuple<BodyId, BodyDef, Pose>>;

  Handles handles_;
  std::vector<BodyId> bodies_;
  std::shared_ptr<Start> start_;
  Pose frame_;
  Aabb bounds_;  ///< bounds of the body dragged directly, relative to the frame's origin
  std::optional<Displacement> last_;
  bool active_ = false;
};

}  // namespace tumble
