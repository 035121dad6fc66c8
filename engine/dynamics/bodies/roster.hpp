#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Which bodies a tick looks at. The others sleep, are fixed or do not move, and whatever was
/// worked out of them in an earlier tick still holds: a world of sleepers costs what its few awake
/// bodies cost.
class Roster {
 public:
  /// From here on nothing is known: something else than a tick may have changed any body.
  void forget() { known_ = false; }
  /// Something else than a tick changed this body, and no other.
  void touch(uint32_t slot) { touched_.push_back(slot); }
  /// Brings the roster up to date before a tick, or after forget() within one. Every body is looked
  /// at if forget() was called or bodies came or went; else those of the last roster and the
  /// touched.
  void refresh(std::span<const RigidBody> bodies, Crew* crew = nullptr);
  /// Bodies that woke during the tick, ascending; none is in the roster yet.
  void add(std::span<const uint32_t> woken);

  bool known() const { return known_; }
  /// Whether any body may have changed since the tick before.
  bool everything() const { return !known_ || whole_; }
  /// Slots of the bodies that seek contacts, ascending.
  std::span<const uint32_t> active() const { return active_; }
  /// Slots, ascending, of those that have come to rest: they did at the last refresh, or were
  /// touched, and do not.
  std::span<const uint32_t> settled() const { return settled_; }
  /// Slots of those that were touched since the last refresh.
  std::span<const uint32_t> touched() const { return touched_; }

  void add_memory(MemoryUse& use) const;

 private:
  bool known_ = false;
  bool whole_ = true;  ///< the last refresh looked at every body
  size_t size_ = 0;    ///< bodies
  std::vector<uint32_t> active_, settled_, touched_;
  std::vector<uint8_t> seeks_;  ///< scratch
};

}  // namespace tumble
