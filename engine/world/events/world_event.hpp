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
  joint_broken,  ///< it bore too much
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
  uint64_t tick = 0;  ///< after which it had happened
  double time = 0;    ///< of the end of that tick [s]
  WorldEventKind kind = WorldEventKind::impact;
  BodyId a, b;         ///< null where there is none
  std::string name_a;  ///< of a; of the joint, or of the particle system
  std::string name_b;  ///< of b
  uint64_t count = 1;  ///< of what it speaks of together
  /// Of an impact: how much more the two pushed each other in the tick than in the one before.
  double impulse = 0;           ///< [N s]
  Vec3 x_world = Vec3::Zero();  ///< where, of an impact [m]
};

/// "ball against floor, 2.3 N s", "3 bodies: crate[0], ...".
std::string event_text(const WorldEvent& event);

/// Which events somebody wants to see.
struct EventFilter {
  std::optional<WorldEventKind> kind = WorldEventKind::impact;  ///< none: all
  std::string body;          ///< a part of the name of one of the two, in any case of letters
  double least_impulse = 0;  ///< of impacts [N s]

  bool takes(const WorldEvent& event) const;
};

/// The events of a world's history up to now; the oldest are forgotten when there are too many.
class EventLog {
 public:
  static constexpr size_t most = 4096;

  void add(std::vector<WorldEvent> events);
  /// What happened after a tick has not happened.
  void forget_after(uint64_t tick);
  const std::vector<WorldEvent>& events() const { return events_; }  ///< by tick

 private:
  std::vector<WorldEvent> events_;
};

}  // namespace tumble
