#pragma once
#include "engine/world/events/world_event.hpp"
#include "engine/world/frame.hpp"

#include <memory>
#include <vector>

namespace tumble {

/// Finds out what happened in a tick by comparing its frame with that of the tick before: contacts
/// and velocities, joints, sleep, bodies and particles that are new or gone, and the statistics. It
/// reads nothing but frames, and costs about one pass over the contacts.
class EventGatherer {
 public:
  /// Starts anew at another moment of the history: the next comparison is with this frame.
  void go_to(const Frame& frame);
  /// The events of the tick that led to this frame, which must be the tick after that of the last
  /// frame seen.
  std::vector<WorldEvent> see(const Frame& frame);

 private:
  struct PairPush {
    BodyId a, b;
    Vec3 impulse = Vec3::Zero();  ///< of all their contacts [N s]
    /// Of the contact with the largest impulse [N s].
    double most = 0;
    Vec3 x = Vec3::Zero(), normal = Vec3::UnitY();  ///< of that contact
  };
  struct System {
    ParticleSystemId id;
    uint64_t last_id = 0;
    size_t count = 0;
  };
  static std::vector<PairPush> pushes_of(const Frame& frame);
  static std::vector<System> systems_of(const Frame& frame);
  const BodyFrame* before(BodyId id) const;
  double normal_speed(const PairPush& pair, const BodyFrame* a, const BodyFrame* b) const;
  void find_impacts(const Frame& frame, const std::vector<PairPush>& now,
                    std::vector<WorldEvent>& out) const;
  void find_body_changes(const Frame& frame, std::vector<WorldEvent>& out) const;
  void find_broken(const Frame& frame, std::vector<WorldEvent>& out) const;
  void find_particles(const Frame& frame, const std::vector<System>& now,
                      std::vector<WorldEvent>& out) const;

  // Copied from the frame before.
  std::vector<std::shared_ptr<const Frame::BodyChunk>> chunks_;
  std::shared_ptr<const std::vector<BodyInfo>> infos_;
  std::shared_ptr<const std::vector<JointFrame>> joints_;
  std::vector<PairPush> pushes_;  ///< by bodies
  std::vector<System> systems_;
};

}  // namespace tumble
