#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Lets the forces of the present moment be asked for between ticks: while it lasts the bodies end
/// with the particles that act on them, and all may be moved about. It then gives the state back as
/// it was.
class PresentMoment {
 public:
  explicit PresentMoment(WorldState& state);
  ~PresentMoment();
  PresentMoment(const PresentMoment&) = delete;
  PresentMoment& operator=(const PresentMoment&) = delete;

  /// Whether the particles could be made.
  const Status& status() const { return status_; }

 private:
  WorldState& state_;
  std::vector<RigidBody> bodies_;
  std::vector<std::vector<Vec3>> forces_;  ///< on particles, by system
  Status status_;
};

}  // namespace tumble
