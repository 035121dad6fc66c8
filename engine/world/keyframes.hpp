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

/// Snapshots of the past within a memory budget, for stepping back and restarting. The first
/// keyframe is never dropped; the others thin out with age. A copy shares the snapshots, and can
/// replace the ring later when the world returns to the moment of the copy.
class KeyframeRing {
 public:
  explicit KeyframeRing(size_t budget_bytes = size_t{256} << 20, uint64_t interval_ticks = 30)
      : budget_(budget_bytes), interval_(interval_ticks) {}

  /// Drops all keyframes and keeps the present state as the first.
  void reset(const World& world);
  /// To be called after each step: keeps a keyframe when one is due.
  void after_step(const World& world);
  /// Keeps a keyframe of the present state, due or not, so that going back to this tick restores
  /// the changes made at it.
  void keep(const World& world);
  /// Brings the world to `tick` (not later than now) as it was left there: loads the last keyframe
  /// up to that tick, and repeats the steps and logged commands from there, those of that tick
  /// included. `before` gets the frame of the tick before it, or null if no step was repeated.
  Status seek(World& world, uint64_t tick, std::shared_ptr<const Frame>* before = nullptr);
  /// Repeats the way that led to the present of `world`, from `from` or the first keyframe on:
  /// `each` sees the world at every tick as it was left there, and says whether to go on. For a
  /// world of the same history that nobody else looks at.
  Status walk(World& world, uint64_t from, const std::function<bool(const World&)>& each) const;
  /// Brings the world to the first keyframe, without later changes at its tick.
  Status restart(World& world);
  uint64_t first_tick() const { return frames_.empty() ? 0 : frames_.front().tick; }
  /// Tick of the newest keyframe.
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
