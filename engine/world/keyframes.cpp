#include "engine/world/keyframes.hpp"

#include "engine/world/world.hpp"

#include <algorithm>
#include <vector>

namespace tumble {
namespace {

Error no_keyframe() {
  return {ErrorCode::not_found, "there is no keyframe to go back to", {}, {}};
}

/// Brings a world that was put back to a keyframe on to `tick`, with the commands of that time,
/// which `log` has: those of `tick` itself, too, for what was changed there belongs to the world as
/// it was left. `next`, before each step, says whether to go on.
Status go_on_to(World& world, uint64_t tick, const std::vector<LoggedCommand>& log,
                const std::function<Result<bool>()>& next) {
  // Commands logged at the keyframe's own tick were applied before it was taken or are still to
  // come, which the snapshot's queue knows; later ones are submitted again when their tick comes.
  size_t submitted = world.replay_log().entries().size();
  const auto submit_due = [&]() -> Status {
    while (submitted < log.size() && log[submitted].tick <= world.tick())
      if (Status s = world.submit(log[submitted++].command); !s) return s;
    return {};
  };
  while (world.tick() < tick) {
    if (Status s = submit_due(); !s) return s;
    const Result<bool> goes_on = next();
    if (!goes_on) return goes_on.error();
    if (!*goes_on) return {};
    if (auto report = world.step(); !report) return report.error();
  }
  if (Status s = submit_due(); !s) return s;
  return world.apply_commands();
}

}  // namespace

void KeyframeRing::reset(const World& world) {
  frames_.clear();
  bytes_ = 0;
  keep(world);
}

void KeyframeRing::after_step(const World& world) {
  if (!frames_.empty() && world.tick() < frames_.back().tick + interval_) return;
  keep(world);
}

void KeyframeRing::keep(const World& world) {
  frames_.push_back({world.tick(), std::make_shared<const Bytes>(world.save(false))});
  bytes_ += frames_.back().snapshot->size();
  if (bytes_ > budget_) thin();
}

/// Drops every second keyframe of the older half until the budget is met; the first one stays.
void KeyframeRing::thin() {
  while (bytes_ > budget_ && frames_.size() > 2) {
    std::deque<Keyframe> kept;
    const size_t half = std::max<size_t>(frames_.size() / 2, 2);
    for (size_t i = 0; i < frames_.size(); ++i) {
      const bool drop = i > 0 && i <= half && i % 2 == 1 && i + 1 < frames_.size();
      if (drop)
        bytes_ -= frames_[i].snapshot->size();
      else
        kept.push_back(std::move(frames_[i]));
    }
    if (kept.size() == frames_.size()) break;
    frames_ = std::move(kept);
  }
}

void KeyframeRing::drop_last() {
  bytes_ -= frames_.back().snapshot->size();
  frames_.pop_back();
}

Status KeyframeRing::seek(World& world, uint64_t tick, std::shared_ptr<const Frame>* before) {
  if (before) before->reset();
  if (frames_.empty()) return no_keyframe();
  if (tick > world.tick())
    return Error{ErrorCode::invalid_argument, "cannot seek to a tick in the future", {}, {}};
  tick = std::max(tick, frames_.front().tick);
  const auto after = std::upper_bound(frames_.begin(), frames_.end(), tick,
                                      [](uint64_t t, const Keyframe& k) { return t < k.tick; });
  const auto from = std::prev(after);
  const std::vector<LoggedCommand> log = world.replay_log().entries();
  if (Status s = world.rewind(*from->snapshot); !s) return s;
  while (frames_.size() > 1 && frames_.back().tick > tick) drop_last();
  return go_on_to(world, tick, log, [&]() -> Result<bool> {
    // Frames are made when they are asked for: only the last one is.
    if (before && world.tick() + 1 == tick) *before = world.frame();
    return true;
  });
}

Status KeyframeRing::walk(World& world, uint64_t from,
                          const std::function<bool(const World&)>& each) const {
  if (frames_.empty()) return no_keyframe();
  // One before it: what a tick tells besides its state is known after a step only.
  auto start = std::lower_bound(frames_.begin(), frames_.end(), from,
                                [](const Keyframe& k, uint64_t t) { return k.tick < t; });
  if (start != frames_.begin()) --start;
  const uint64_t end = world.tick();
  const std::vector<LoggedCommand> log = world.replay_log().entries();
  if (Status s = world.rewind(*start->snapshot); !s) return s;
  bool goes_on = true;
  const auto show = [&]() -> Result<bool> {
    if (Status s = world.apply_commands(); !s) return s.error();
    return goes_on = world.tick() < from || each(world);
  };
  if (Status s = go_on_to(world, end, log, show); !s || !goes_on) return s;
  (void)each(world);
  return {};
}

Status KeyframeRing::restart(World& world) {
  if (frames_.empty()) return no_keyframe();
  if (Status s = world.rewind(*frames_.front().snapshot); !s) return s;
  while (frames_.size() > 1) drop_last();
  return {};
}

}  // namespace tumble
