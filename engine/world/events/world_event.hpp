#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble {

enum class WorldEventKind : uint8_t {
  impact,        ///< two bodies struck each other
  joint_broken,  ///< its load exceeded its strength
  fell_asleep,
  woke,
  births,        ///< of bodies, or of particles of a system
  deaths,        ///< likewise
  time_stepped,  ///< groups of the event stepper that time-stepping moved
};
inline constexpr size_t world_event_kinds = 7;
/// "impact", "joint broken", ...
std::string_view event_kind_name(WorldEventKind kind);

/// Something that happened in a tick.
struct WorldEvent {
  uint64_t tick = 0;  ///< number of ticks done when it had happened
  double time = 0;    ///< at the end of that tick [s]
  WorldEventKind kind = WorldEventKind::impact;
  BodyId a, b;         ///< null where there is none
  std::string name_a;  ///< of a; of the joint, or of the particle system
  std::string name_b;  ///< of b
  uint64_t count = 1;  ///< number of bodies, particles or groups that this entry stands for
  /// Of an impact: the impulse between the two bodies in the tick, less that in the tick before.
  double impulse = 0;           ///< [N s]
  Vec3 x_world = Vec3::Zero();  ///< contact point of an impact [m]
};

/// "ball against floor, 2.3 N s", "3 bodies: crate[0], ...".
std::string event_text(const WorldEvent& event);

/// Which events a user wants to see.
struct EventFilter {
  std::optional<WorldEventKind> kind = WorldEventKind::impact;  ///< none: all
  std::string body;          ///< a part of the name of one of the two, in any case of letters
  double least_impulse = 0;  ///< of impacts [N s]

  bool takes(const WorldEvent& event) const;
};

/// The events of a world's history up to now; when there are more than `most`, the oldest are
/// dropped.
class EventLog {
 public:
  static constexpr size_t most = 4096;

  void add(std::vector<WorldEvent> events);
  /// Removes the events after a tick, for a world that has gone back to it.
  void forget_after(uint64_t tick);
  /// In the order of their ticks.
  const std::vector<WorldEvent>& events() const { return events_; }

 private:
  std::vector<WorldEvent> events_;
};

}  // namespace tumble
