#pragma once
#include "engine/core/bytes.hpp"
#include "engine/core/result.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <span>

namespace tumble {

struct Frame;
class World;

/// Snapshots of the past within a memory budget, behind "step back" and "restart". The first
/// keyframe is never dropped; the others thin out with age. A copy shares the snapshots: it is the
/// past as it is known now, to be taken up again when the world goes back to this moment.
class KeyframeRing {
 public:
  explicit KeyframeRing(size_t budget_bytes = size_t{256} << 20, uint64_t interval_ticks = 30)
      : budget_(budget_bytes), interval_(interval_ticks) {}

  /// Forgets everything and keeps the world as it is now as the first keyframe.
  void reset(const World& world);
  /// Call after each step: keeps a keyframe when one is due.
  void after_step(const World& world);
  /// Keeps the world as it is now, due or not: going back to this tick finds it with the changes
  /// that were made at this tick.
  void keep(const World& world);
  /// Brings the world to `tick` (not later than now) as it was left there: the nearest keyframe
  /// before it, then steps with the logged commands, and those of that tick itself. `before` gets
  /// the frame of the tick before it, or null where that is not on the way.
  Status seek(World& world, uint64_t tick, std::shared_ptr<const Frame>* before = nullptr);
  /// Goes the way that led to the present of `world` once more, from `from` or the first keyframe
  /// on: `each` sees the world at every tick as it was left there, and says whether to go on. For a
  /// world of the same history that nobody else looks at.
  Status walk(World& world, uint64_t from, const std::function<bool(const World&)>& each) const;
  /// Brings the world to the first keyframe, without what was changed at its tick afterwards.
  Status restart(World& world);
  uint64_t first_tick() const { return frames_.empty() ? 0 : frames_.front().tick; }
  /// Of the newest keyframe.
  uint64_t last_tick() const { return frames_.empty() ? 0 : frames_.back().tick; }
  size_t bytes() const { return bytes_; }
  size_t count() const { return frames_.size(); }

 private:
  struct Keyframe {
    uint64_t tick;
    std::shared_ptr<const Bytes> snapshot;
  };
  void thin();
  void drop_last();

  std::deque<Keyframe> frames_;
  size_t bytes_ = 0;
  size_t budget_;
  uint64_t interval_;
};

}  // namespace tumble
