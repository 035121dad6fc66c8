#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"
#include "engine/world/command.hpp"
#include "engine/world/world_def.hpp"

#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// The replay log of a world as bytes: its origin, the geometry that commands name, the commands,
/// and the tick and state hash of now.
Bytes save_replay(const World& world);

/// A replay log, read: what was done to a world that began as its origin, and how that ended.
class Replay {
 public:
  /// Error: the bytes are damaged, or of another version.
  static Result<Replay> read(std::span<const std::byte> bytes);

  uint64_t last_tick() const { return last_tick_; }
  uint64_t last_hash() const { return last_hash_; }

  /// A world at the origin, before the first command.
  Result<std::unique_ptr<World>> begin(WorldDef def = {}) const;
  /// Whether a world began as the recorded one: the same origin, and all that was done to it so far
  /// (a scene built in it, say) is what was recorded first.
  bool begins_as(const World& world) const;

  enum class Course { goes_on, ended_same, ended_otherwise, left };
  /// Does to the world what was done at its tick, unless it was done already: to be called at the
  /// first tick and after each further one. Nothing is remembered of earlier calls, so the world
  /// may go back in between. `left`: something else was done to it, and nothing is done here;
  /// where that is taken back, the replay goes on.
  Result<Course> follow(World& world) const;

 private:
  Replay() = default;
  /// Commands of the ticks before this one.
  size_t count_before(uint64_t tick) const;
  bool same_commands(const World& world, size_t first) const;

  uint64_t last_tick_ = 0, last_hash_ = 0;
  Bytes origin_;
  std::shared_ptr<ShapeStore> shapes_;
  std::vector<LoggedCommand> commands_;  ///< by tick
};

struct Replayed {
  std::unique_ptr<World> world;
  bool same = false;  ///< the state hash at the end is the recorded one
};

/// Builds the world of a replay log and runs it to the recorded tick.
Result<Replayed> run_replay(std::span<const std::byte> replay, WorldDef def = {});

}  // namespace tumble
