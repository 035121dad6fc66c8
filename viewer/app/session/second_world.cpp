#include "viewer/app/session/second_world.hpp"

#include "engine/world/world.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

constexpr size_t most_samples = 480;

}  // namespace

void SecondWorld::stop_with(const StopFlag* flag) {
  stop_ = flag;
  if (world_) world_->stop_with(flag);
}

void SecondWorld::begin(const World& a) {
  world_.reset();
  {
    std::lock_guard lock(mutex_);
    shown_ = {};
  }
  auto made = World::create();
  if (!made) return fail(made.error().text());
  if (const Status loaded = (*made)->load(a.save()); !loaded) return fail(loaded.error().text());
  if (const Status set = (*made)->set_settings(settings_); !set) return fail(set.error().text());
  if (const Status done = (*made)->apply_commands(); !done) return fail(done.error().text());
  world_ = std::move(*made);
  world_->stop_with(stop_);
  begun_a_ = a.tick();
  begun_b_ = world_->tick();
  commands_ = a.replay_log().entries().size();
  keyframes_.reset(*world_);
  see(a);
}

double SecondWorld::ticks_of_b(const World& a) const {
  return double(a.tick() - begun_a_) * a.settings().tick.tick() / world_->settings().tick.tick();
}

void SecondWorld::go_back(const World& a) {
  if (!world_ || a.tick() < begun_a_) return begin(a);
  const uint64_t tick = begun_b_ + uint64_t(ticks_of_b(a) + 1e-6);
  if (tick < keyframes_.first_tick()) return begin(a);
  if (tick < world_->tick())
    if (const Status found = keyframes_.seek(*world_, tick); !found)
      return fail(found.error().text());
  commands_ = a.replay_log().entries().size();
  see(a);
}

/// What A was told until this time since the beginning [s].
void SecondWorld::carry_out(const World& a, double until) {
  const auto& log = a.replay_log().entries();
  const double tick = a.settings().tick.tick();
  for (; commands_ < log.size(); ++commands_) {
    const LoggedCommand& entry = log[commands_];
    if (double(entry.tick - begun_a_) * tick > until + 0.5 * tick) return;
    if (std::holds_alternative<SetSettings>(entry.command)) continue;  // B has its own
    (void)world_->submit(entry.command);  // what B has lost cannot be changed in it
  }
}

void SecondWorld::follow(const World& a) {
  if (!world_) return;
  const double step_b = world_->settings().tick.tick(), end = ticks_of_b(a) + 1e-6;
  while (double(world_->tick() - begun_b_) + 1 <= end) {
    carry_out(a, double(world_->tick() - begun_b_) * step_b);
    const auto done = world_->step();
    if (!done) {
      if (done.error().code != ErrorCode::cancelled) fail(done.error().text());
      return;
    }
    keyframes_.after_step(*world_);
  }
  carry_out(a, end * step_b);
  (void)world_->apply_commands();
  see(a);
}

void SecondWorld::see(const World& a) {
  const auto frame_a = a.frame(), frame_b = world_->frame();
  const Divergence d = divergence(*frame_a, *frame_b);
  const double apart = double(frame_a->tick - begun_a_) * a.settings().tick.tick() -
                       double(frame_b->tick - begun_b_) * world_->settings().tick.tick();
  std::lock_guard lock(mutex_);
  if (!shown_.to) {
    shown_.from = shown_.to = frame_b;
    shown_.tick_from = shown_.tick_to = frame_a->tick;
  } else if (frame_a->tick != shown_.tick_to) {
    shown_.from = std::exchange(shown_.to, frame_b);
    shown_.tick_from = std::exchange(shown_.tick_to, frame_a->tick);
  } else {
    shown_.to = frame_b;
  }
  // Only at moments that both have.
  if (std::abs(apart) > 1e-9) return;
  shown_.now = d;
  if (!d.same_bits && !shown_.first) shown_.first = d;
  if (shown_.samples.empty() || d.distance > shown_.worst.distance) shown_.worst = d;
  if (!shown_.samples.empty() && shown_.samples.back().time >= d.time) return;
  shown_.samples.push_back({d.time, d.distance});
  if (shown_.samples.size() > most_samples) shown_.samples.erase(shown_.samples.begin());
}

SecondWorld::Shown SecondWorld::shown() const {
  std::lock_guard lock(mutex_);
  return shown_;
}

void SecondWorld::fail(const std::string& why) {
  std::lock_guard lock(mutex_);
  shown_.fault = why;
}

}  // namespace tumble
