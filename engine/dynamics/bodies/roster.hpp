#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/memory_use.hpp"
#include "engine/dynamics/bodies/body.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// The bodies that a tick must visit. The others sleep, are fixed or do not move, and results for
/// them from earlier ticks still hold: the cost of a world depends on its awake bodies only.
class Roster {
 public:
  /// Declares that any body may have changed other than by a tick.
  void forget() { known_ = false; }
  /// Declares that this body, and no other, was changed other than by a tick.
  void touch(uint32_t slot) { touched_.push_back(slot); }
  /// Updates the roster before a tick, or within one after forget(). Visits every body if forget()
  /// was called or the number of bodies changed; otherwise those of the last roster and the touched
  /// ones.
  void refresh(std::span<const RigidBody> bodies, Crew* crew = nullptr);
  /// Adds bodies that woke during the tick, ascending; none may be in the roster yet.
  void add(std::span<const uint32_t> woken);

  bool known() const { return known_; }
  /// Whether any body may have changed since the previous tick.
  bool everything() const { return !known_ || whole_; }
  /// Slots of the active bodies (is_active), ascending.
  std::span<const uint32_t> active() const { return active_; }
  /// Slots, ascending, of bodies that are not active but were at the last refresh, or were touched.
  std::span<const uint32_t> settled() const { return settled_; }
  /// Slots of the bodies that were touched since the last refresh.
  std::span<const uint32_t> touched() const { return touched_; }

  void add_memory(MemoryUse& use) const;

 private:
  bool known_ = false;
  bool whole_ = true;  ///< the last refresh visited every body
  size_t size_ = 0;    ///< number of bodies
  std::vector<uint32_t> active_, settled_, touched_;
  std::vector<uint8_t> seeks_;  ///< scratch memory
};

}  // namespace tumble
