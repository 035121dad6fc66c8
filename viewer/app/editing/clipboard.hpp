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

/// Where pasted bodies come to stand: on a face with this normal.
struct PastePlace {
  Vec3 x = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();
};

/// Bodies that were copied, to be pasted into this scene or another.
class BodyClipboard {
 public:
  /// Takes what the bodies of a scene are at this moment.
  void copy(Session& session, const Selection& bodies, const std::string& scene);
  /// Nothing was copied.
  bool empty() const { return count_ == 0; }
  size_t count() const { return count_; }
  /// Copies of them in a scene, so that the box around them stands in the middle of the place.
  std::future<std::vector<BodyId>> paste(Session& session, const std::string& scene,
                                         const PastePlace& place, DeedEdits edits,
                                         Refusal refusal) const;

 private:
  size_t count_ = 0;
  std::string scene_;                    ///< that they are of
  std::shared_ptr<CopiedBodies> group_;  ///< filled and read on the simulation thread
};

}  // namespace tumble
