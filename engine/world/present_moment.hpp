#pragma once
#include "engine/world/state.hpp"

namespace tumble {

/// Allows forces to be evaluated between ticks: during its life the particles that act on bodies
/// are appended to the bodies as blocks, and all may be changed. The destructor restores the state.
class PresentMoment {
 public:
  explicit PresentMoment(WorldState& state);
  ~PresentMoment();
  PresentMoment(const PresentMoment&) = delete;
  PresentMoment& operator=(const PresentMoment&) = delete;

  /// Error: the blocks could not be made.
  const Status& status() const { return status_; }

 private:
  WorldState& state_;
  std::vector<RigidBody> bodies_;
  std::vector<std::vector<Vec3>> forces_;  ///< on particles, by system
  Status status_;
};

}  // namespace tumble
