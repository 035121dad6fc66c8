#pragma once
#include "engine/scene/build/live_parts.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/session.hpp"

#include <future>
#include <memory>
#include <vector>

namespace tumble {

/// Applies an edit to a list of parts.
void fold_part(SceneDescription& parts, const SceneEdit& edit);

/// The emitters, sensors, forces and particles of the scene as its file would describe them now:
/// those of the file, with the edits in effect.
class PartsController {
 public:
  /// `live`: their ids in the world; only the simulation thread reads it.
  void open(std::shared_ptr<const SceneDescription> parts, std::shared_ptr<LiveParts> live);
  /// To be called after a change or undo.
  void note() { stale_ = true; }
  /// Takes an answer that has arrived, and sends a new query if it is outdated.
  void update(Session& session, const std::vector<UndoStepEdits>& undo_steps);
  /// Gives names to unnamed springs of a change; must be posted before any other job that reads its
  /// edits.
  void name_springs(Session& session, UndoStepEdits edits) const;
  /// Shows a change, or a removal (`gone`), before the world has executed it.
  void expect(const std::string& name, const PartDescription& part, bool gone = false);

  const std::shared_ptr<const SceneDescription>& parts() const { return now_; }
  const std::shared_ptr<const SceneDescription>& opened() const { return opened_; }
  const std::shared_ptr<LiveParts>& live() const { return live_; }

 private:
  std::shared_ptr<const SceneDescription> opened_, now_;
  std::shared_ptr<LiveParts> live_;
  std::future<std::vector<SceneEdit>> collected_;
  bool stale_ = false;
};

}  // namespace tumble
