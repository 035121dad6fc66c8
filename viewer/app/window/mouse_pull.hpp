#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "viewer/app/session/session.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// Pulls bodies by a mouse spring: created when a body is grabbed, moved with the pointer, and
/// destroyed on release. All this is done by World commands, so that going back in time and replays
/// reproduce the pulls; when the session goes back into such a pull, its spring is removed.
class MousePull {
 public:
  void take(Session& session, const MouseSpringDef& spring);
  void move(Session& session, const MouseSpringDef& spring);
  void turn(Session& session, BodyId body, const Vec3& omega);
  void let_go(Session& session);
  /// Removes its springs that exist at the moment to which the session has gone back.
  void let_go_of_the_past(Session& session);
  bool holds() const { return holds_; }
  /// To be called when another world is shown.
  void forget() { *this = MousePull{}; }

 private:
  /// Accessed only by jobs of the session, which run in order.
  struct Springs {
    ForceId held;
    std::vector<ForceId> made;  ///< all springs made in this world; most no longer exist
  };
  std::shared_ptr<Springs> springs_ = std::make_shared<Springs>();
  bool holds_ = false;
};

}  // namespace tumble
