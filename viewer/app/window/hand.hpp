#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "viewer/app/session/session.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace tumble {

/// The hand of a person in the world: a mouse spring that is made when a body is taken, follows the
/// pointer, and goes when it is let go. All of it are commands of the world, so that going back and
/// replays find the same pulls; in the past that one goes back to nobody holds anything.
class Hand {
 public:
  void take(Session& session, const MouseSpringDef& spring);
  void move(Session& session, const MouseSpringDef& spring);
  void turn(Session& session, BodyId body, const Vec3& omega);
  void let_go(Session& session);
  /// Lets go of what was held at the moment to which the session has gone back.
  void let_go_of_the_past(Session& session);
  bool holds() const { return holds_; }
  /// Another world is shown.
  void forget() { *this = Hand{}; }

 private:
  /// Touched by jobs only, which run in order.
  struct Springs {
    ForceId held;
    std::vector<ForceId> made;  ///< by this hand in this world; many are gone
  };
  std::shared_ptr<Springs> springs_ = std::make_shared<Springs>();
  bool holds_ = false;
};

}  // namespace tumble
