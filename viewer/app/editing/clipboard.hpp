#pragma once
#include "engine/math/types.hpp"
#include "viewer/app/editing/copied_bodies.hpp"
#include "viewer/app/session/refusal.hpp"
#include "viewer/app/session/session.hpp"
#include "viewer/interact/selection.hpp"

#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// Where to paste bodies: on a face with this normal.
struct PastePlace {
  Vec3 x = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();
};

/// Copied bodies, to be pasted into this scene or another.
class BodyClipboard {
 public:
  /// Copies the present state of bodies of a scene.
  void copy(Session& session, const Selection& bodies, const std::string& scene);
  /// Whether there is nothing to paste.
  bool empty() const { return count_ == 0; }
  size_t count() const { return count_; }
  /// Pastes copies into a scene, with the centre of their bounding box above the place.
  std::future<std::vector<BodyId>> paste(Session& session, const std::string& scene,
                                         const PastePlace& place, UndoStepEdits edits,
                                         Refusal refusal) const;

 private:
  size_t count_ = 0;
  std::string scene_;                    ///< the scene that they come from
  std::shared_ptr<CopiedBodies> group_;  ///< filled and read on the simulation thread
};

}  // namespace tumble
