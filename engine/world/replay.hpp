#pragma once
#include "engine/world/world.hpp"

#include <memory>
#include <span>

namespace tumble {

/// The replay log of a world as bytes: its origin, the geometry that commands name, the commands,
/// and the tick and state hash of now.
Bytes save_replay(const World& world);

struct Replayed {
  std::unique_ptr<World> world;
  bool same = false;  ///< the state hash at the end is the recorded one
};

/// Builds the world of a replay log and runs it to the recorded tick.
Result<Replayed> run_replay(std::span<const std::byte> replay, WorldDef def = {});

}  // namespace tumble
