#include "viewer/app/session/second_world.hpp"

#include "engine/dynamics/simd/simd_target.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace tumble {
namespace {

constexpr size_t most_samples = 480;

/// Whether ids have the same meaning in both: the same bodies and joints in the same slots.
bool made_alike(const Frame& a, const Frame& b) {
  const size_t slots = std::max(a.body_slots(), b.body_slots());
  for (size_t slot = 0; slot < slots; ++slot) {
    const bool in_a = slot < a.body_slots() && !a.body(slot).id.is_null();
    const bool in_b = slot < b.body_slots() && !b.body(slot).id.is_null();
    if (in_a != in_b) return false;
    if (in_a && (a.body(slot).id != b.body(slot).id || a.info(slot).name != b.info(slot).name))
      return false;
  }
  const std::vector<JointFrame> none;
  const auto &p = a.joints ? *a.joints : none, &q = b.joints ? *b.joints : none;
  return std::ranges::equal(p, q, [](const JointFrame& j, const JointFrame& k) {
    return j.id == k.id && j.name == k.name;
  });
}

}  // namespace

SecondWorld::SecondWorld(WorldChoice choice, const World& made)
    : choice_(std::move(choice)), origin_(made.save()) {
  choice_.settings = made.settings();
}

void SecondWorld::stop_with(const StopFlag* flag) {
  stop_ = flag;
  if (world_) world_->stop_with(flag);
}

void SecondWorld::begin(const World& a, double seconds) {
  world_.reset();
  failed_ = false;
  {
    std::lock_guard lock(mutex_);
    shown_ = {};
  }
  if (const Status made = make(a); !made) {
    world_.reset();
    return fail(made.error().text());
  }
  world_->stop_with(stop_);
  begun_b_ = world_->tick();
  // A world with other numbers starts at its first tick, and A is restarted together with it.
  begun_a_ = from_start() ? begun_b_ : a.tick();
  const auto& log = a.replay_log().entries();
  commands_ = log.size();
  if (a.tick() > begun_a_)
    commands_ =
        size_t(std::ranges::upper_bound(log, begun_a_, {}, &LoggedCommand::tick) - log.begin());
  {
    std::lock_guard lock(mutex_);
    shown_.alone = from_start() && !made_alike(*a.frame(), *world_->frame());
  }
  keyframes_.reset(*world_);
  follow(a, seconds);
}

Status SecondWorld::make(const World& a) {
  WorldDef def;
  def.threads = choice_.threads;
  auto made = World::create(std::move(def));
  if (!made) return made.error();
  world_ = std::move(*made);
  if (const Status done = world_->load(from_start() ? origin_ : a.save()); !done) return done;
  if (const Status done = world_->set_settings(choice_.settings); !done) return done;
  const SimdTarget target(choice_.simd);
  return world_->apply_commands();
}

double SecondWorld::ticks_of_b(const World& a) const {
  return double(a.tick() - begun_a_) * a.settings().tick.tick() / world_->settings().tick.tick();
}

void SecondWorld::go_back(const World& a, double seconds) {
  if (!world_ || a.tick() < begun_a_) return begin(a, seconds);
  const uint64_t tick = begun_b_ + uint64_t(ticks_of_b(a) + 1e-6);
  if (tick < keyframes_.first_tick()) return begin(a, seconds);
  const SimdTarget target(choice_.simd);
  const size_t told = a.replay_log().entries().size();
  if (tick > world_->tick()) {  // it was on its way, and had not come so far
    commands_ = std::min(commands_, told);
    return follow(a, seconds);
  }
  if (tick < world_->tick())
    if (const Status found = keyframes_.seek(*world_, tick); !found)
      return fail(found.error().text());
  commands_ = told;
  see(a);
}

/// Applies the commands given to A up to this time since the comparison began [s].
void SecondWorld::carry_out(const World& a, double until) {
  const auto& log = a.replay_log().entries();
  const double tick = a.settings().tick.tick();
  for (; commands_ < log.size(); ++commands_) {
    const LoggedCommand& entry = log[commands_];
    if (double(entry.tick - begun_a_) * tick > until + 0.5 * tick) return;
    if (shown_.alone) continue;  // ids would refer to other bodies
    if (std::holds_alternative<SetSettings>(entry.command)) continue;  // B has its own settings
    (void)world_->submit(entry.command);  // a command for something that B has lost is ignored
  }
}

bool SecondWorld::behind(const World& a) const {
  return world_ && !failed_ && double(world_->tick() - begun_b_) + 1 <= ticks_of_b(a) + 1e-6;
}

void SecondWorld::follow(const World& a, double seconds) {
  if (!world_) return;
  if (failed_) return see(a);  // and is told nothing more
  using Clock = std::chrono::steady_clock;
  const auto since = Clock::now();
  const SimdTarget target(choice_.simd);
  const double step_b = world_->settings().tick.tick(), end = ticks_of_b(a) + 1e-6;
  while (behind(a)) {
    carry_out(a, double(world_->tick() - begun_b_) * step_b);
    const auto done = world_->step();
    if (!done) {
      if (done.error().code != ErrorCode::cancelled) fail(done.error().text());
      return;
    }
    keyframes_.after_step(*world_);
    if (std::chrono::duration<double>(Clock::now() - since).count() >= seconds) break;
  }
  if (behind(a)) return see(a);
  carry_out(a, end * step_b);
  (void)world_->apply_commands();
  see(a);
}

void SecondWorld::see(const World& a) {
  const auto frame_a = a.frame(), frame_b = world_->frame();
  const Divergence d = divergence(*frame_a, *frame_b);
  const double apart = double(frame_a->tick - begun_a_) * a.settings().tick.tick() -
                       double(frame_b->tick - begun_b_) * world_->settings().tick.tick();
  const bool catches_up = behind(a);
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
  // With a longer tick B stands at its last one before A's moment, and is not on its way.
  shown_.behind = catches_up ? std::max(0.0, apart) : 0;
  // Only at moments that both have.
  if (std::abs(apart) > 1e-9) return;
  shown_.now = d;
  if (!d.same_bits && !shown_.first) shown_.first = d;
  if (shown_.first && !shown_.first_contact)
    shown_.first_contact = first_contact_difference(*frame_a, *frame_b);
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
  failed_ = true;
  std::lock_guard lock(mutex_);
  shown_.fault = why;
  shown_.behind = 0;
}

}  // namespace tumble
