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
/// and the present tick and state hash.
Bytes save_replay(const World& world);

/// A replay log as it was read: the commands given to a world from its origin, and the final tick
/// and hash.
class Replay {
 public:
  /// Error: the bytes are damaged, or of another version.
  static Result<Replay> read(std::span<const std::byte> bytes);

  uint64_t last_tick() const { return last_tick_; }
  uint64_t last_hash() const { return last_hash_; }

  /// A world at the origin, before the first command.
  Result<std::unique_ptr<World>> begin(WorldDef def = {}) const;
  /// Whether a world began as the recorded one: it has the same origin, and the commands in its log
  /// so far (from building a scene, say) are the first ones of the recording.
  bool begins_as(const World& world) const;

  enum class Course { goes_on, ended_same, ended_otherwise, left };
  /// Applies the recorded commands of the world's present tick, unless they were applied already:
  /// to be called at the first tick and after each further one. It has no memory of earlier calls,
  /// so the world may go back in between. `left`: the world's log differs from the recording, and
  /// nothing is applied; once the difference is undone by going back, the replay continues.
  Result<Course> follow(World& world) const;

 private:
  Replay() = default;
  /// Number of commands at earlier ticks than this.
  size_t count_before(uint64_t tick) const;
  bool same_commands(const World& world, size_t first) const;

  uint64_t last_tick_ = 0, last_hash_ = 0;
  Bytes origin_;
  std::shared_ptr<ShapeStore> shapes_;
  std::vector<LoggedCommand> commands_;  ///< in the order of their ticks
};

struct Replayed {
  std::unique_ptr<World> world;
  bool same = false;  ///< the state hash at the end equals the recorded one
};

/// Builds the world of a replay log and runs it to the recorded tick.
Result<Replayed> run_replay(std::span<const std::byte> replay, WorldDef def = {});

}  // namespace tumble
