#pragma once
#include "engine/scene/build/live_parts.hpp"
#include "viewer/app/editing/scene_saver.hpp"
#include "viewer/app/session/session.hpp"

#include <future>
#include <memory>
#include <vector>

namespace tumble {

/// Carries out in a list of parts what an edit changes about it.
void fold_part(SceneDescription& parts, const SceneEdit& edit);

/// The emitters, sensors, forces and particles of the scene as its file would describe them now:
/// those it was opened with, and what deeds that hold have done since.
class PartsDesk {
 public:
  /// `live`: what these are in the world; only the simulation thread looks into it.
  void open(std::shared_ptr<const SceneDescription> parts, std::shared_ptr<LiveParts> live);
  /// Something was done or taken back.
  void note() { stale_ = true; }
  /// Takes the answer that has come, and asks anew where it would be another.
  void update(Session& session, const std::vector<DeedEdits>& deeds);
  /// Springs of a deed that have no name yet get one; before any other job looks at the deed.
  void name_springs(Session& session, DeedEdits edits) const;
  /// Shows a change before the world has made it, or takes it away.
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
