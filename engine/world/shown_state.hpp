#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"

#include <memory>
#include <span>

namespace tumble {

class World;
struct Frame;

/// A moment of a world that can be shown again: its snapshot, and besides what its frame tells of
/// the tick before, which no later tick reads. Geometry as in World::save().
Bytes save_shown(const World& world, bool with_geometry);

/// Brings a world to such a moment. The frame is the one of then, bit for bit but for the times of
/// stages. Errors: the bytes are damaged, or of another version; the world is as before.
Result<std::shared_ptr<Frame>> load_shown(World& world, std::span<const std::byte> bytes);

/// The part of them that World::load() takes; empty for damaged ones.
std::span<const std::byte> snapshot_of(std::span<const std::byte> shown);

}  // namespace tumble
