#include "viewer/app/session/session.hpp"

#include "engine/world/world.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/app/session/second_world.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>
#include <vector>

namespace tumble {
namespace {

/// Real time is skipped once the simulation is this far behind [s].
constexpr double most_behind = 0.1;
/// A tick under way for longer than this is cancelled by requests to go back [s].
constexpr double slow_tick = 0.1;
/// For so long a second world catches up before others have their turn: a picture at 60 Hz [s].
constexpr double catch_up_slice = 1.0 / 60;
constexpr double no_limit = SecondWorld::no_limit;

using Seconds = std::chrono::duration<double>;

std::chrono::steady_clock::duration to_clock(double seconds) {
  return std::chrono::duration_cast<std::chrono::steady_clock::duration>(Seconds(seconds));
}

/// Pairs of bodies that press on each other, each pair once.
std::vector<std::pair<uint32_t, uint32_t>> pushing_pairs(const Frame& frame) {
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  if (!frame.contacts) return pairs;
  for (const ContactFrame& c : *frame.contacts)  // contacts without an impulse do not press
    if (c.impulse.squaredNorm() > 0) pairs.push_back(std::minmax(c.a.index, c.b.index));
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

bool strikes(const Frame& before, const Frame& after) {
  if (after.stats.impacts > 0) return true;
  const auto old = pushing_pairs(before), now = pushing_pairs(after);
  return !std::includes(old.begin(), old.end(), now.begin(), now.end());
}

}  // namespace

struct Session::Kept {
  Moment moment;
  KeyframeRing keyframes;
  std::atomic<size_t> bytes = 0;  ///< without keyframes, which are shared
};

struct Session::Way {
  Bytes world;  ///< including geometry
  ReplayLog log;
  KeyframeRing keyframes;
  uint64_t tick = 0;
  std::atomic<bool> filled = false;
};

Session::Session(std::unique_ptr<World> world, SessionOptions options)
    : world_(std::move(world)),
      keyframes_(options.keyframe_bytes, options.keyframe_ticks),
      watchers_(std::move(options.watchers)),
      replay_(std::move(options.replay)) {
  counters_.paused = options.paused;
  counters_.speed = options.speed;
  world_->stop_with(&stop_);
  keyframes_.reset(*world_);
  note_rewind();
  publish(0);
}

Session::~Session() {
  {
    std::lock_guard lock(mutex_);
    quit_ = true;
    ++interrupts_;
    stop_.request();
    stop_question_.request();
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Session::start() {
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
}

void Session::enqueue(std::function<void()> job) {
  {
    std::lock_guard lock(mutex_);
    posted_.push_back(std::move(job));
  }
  wake_.notify_all();
}

void Session::interrupt(std::function<void()> job) {
  {
    std::lock_guard lock(mutex_);
    ++interrupts_;
    stop_.request();
    stop_question_.request();
    posted_.push_back([this, job = std::move(job)] {
      {
        std::lock_guard inner(mutex_);
        if (--interrupts_ == 0) stop_.clear();
      }
      job();
    });
  }
  wake_.notify_all();
}

void Session::interrupt_if_slow(std::function<void()> job) {
  if (counters().under_way_seconds > slow_tick)
    interrupt(std::move(job));
  else
    enqueue(std::move(job));
}

void Session::post(std::function<void(World&)> change) {
  enqueue([this, change = std::move(change)] {
    change(*world_);
    if (!world_->apply_commands()) return;
    (void)follow_replay();  // it may have been left
    if (second_) second_->follow(*world_, second_->behind(*world_) ? catch_up_slice : no_limit);
    // While paused nothing else would show it.
    if (paused()) {
      previous_ = world_->frame();
      publish(0);
    }
  });
}

void Session::ask(std::string what, std::function<void(const World&)> question) {
  enqueue([this, what = std::move(what), question = std::move(question)] {
    {
      std::lock_guard lock(mutex_);
      stop_question_.clear();
      if (interrupts_ > 0) stop_question_.request();
      counters_.asking = what;
      asking_since_ = Clock::now();
    }
    {
      const Stoppable scope(&stop_question_);
      question(*world_);
    }
    std::lock_guard lock(mutex_);
    counters_.asking.clear();
    asking_since_.reset();
  });
}

void Session::cancel_question() {
  std::lock_guard lock(mutex_);
  if (asking_since_) stop_question_.request();
}

void Session::set_second(std::shared_ptr<SecondWorld> second) {
  enqueue([this, second = std::move(second)] {
    second_ = second;
    if (!second_) return;
    second_->stop_with(&stop_);
    second_->begin(*world_, catch_up_slice);
  });
}

void Session::set_paused(bool paused) {
  {
    std::lock_guard lock(mutex_);
    counters_.paused = paused;
    if (!paused) fault_.reset();
  }
  wake_.notify_all();
}

bool Session::paused() const {
  std::lock_guard lock(mutex_);
  return counters_.paused;
}

void Session::set_speed(double speed) {
  {
    std::lock_guard lock(mutex_);
    counters_.speed = std::isfinite(speed) ? std::clamp(speed, 1e-3, 1e3) : 1;
  }
  wake_.notify_all();
}

double Session::speed() const {
  std::lock_guard lock(mutex_);
  return counters_.speed;
}

void Session::step(int64_t ticks) {
  set_paused(true);
  const auto move = [this, ticks] {
    const uint64_t now = world_->tick();
    const auto back = uint64_t(-std::min<int64_t>(ticks, 0));
    go_to(ticks >= 0 ? now + uint64_t(ticks) : now - std::min(now, back));
  };
  ticks < 0 ? interrupt_if_slow(move) : enqueue(move);
}

void Session::cancel_tick() {
  set_paused(true);
  interrupt([this] {
    previous_ = world_->frame();
    publish(0);
  });
}

void Session::step_to_impact(double most_seconds) {
  step_until(strikes, most_seconds);
}

std::future<Session::Search> Session::step_until(Found found, double most_seconds) {
  set_paused(true);
  auto search = std::make_shared<std::packaged_task<Search()>>(
      [this, found = std::move(found), most_seconds] {
        return timed([&] { return go_until(found, world_->time() + most_seconds); });
      });
  auto end = search->get_future();
  enqueue([search] { (*search)(); });
  return end;
}

void Session::seek(uint64_t tick) {
  set_paused(true);
  {
    std::lock_guard lock(mutex_);
    ++seeks_asked_;
  }
  // A seek counts as one job, however many ticks it takes: waiting requests can cancel it like a
  // slow tick.
  interrupt_if_slow([this, tick] {
    timed([&] {
      go_to(tick);
      return true;
    });
  });
}

void Session::restart(std::function<void(World&)> begin) {
  interrupt([this, begin = std::move(begin)] {
    {
      std::lock_guard lock(mutex_);
      fault_.reset();
    }
    Status begun = keyframes_.restart(*world_);
    if (begun && begin) {
      begin(*world_);
      begun = world_->apply_commands();
    }
    if (!begun) fail(begun.error());
    if (second_) second_->begin(*world_, catch_up_slice);
    note_rewind();
    publish(0);
  });
}

uint64_t Session::replace(std::unique_ptr<World> world, TickWatchers watchers,
                          std::shared_ptr<ReplayPlayer> replay) {
  auto shared = std::make_shared<std::unique_ptr<World>>(std::move(world));
  uint64_t number = 0;
  {
    std::lock_guard lock(mutex_);
    number = ++worlds_asked_;
  }
  interrupt([this, shared, number, watchers = std::move(watchers), replay = std::move(replay)] {
    world_number_ = number;
    second_.reset();
    watchers_ = watchers;
    replay_ = replay;
    world_ = std::move(*shared);
    world_->stop_with(&stop_);
    keyframes_.reset(*world_);
    {
      std::lock_guard inner(mutex_);
      fault_.reset();
      counters_.dropped_seconds = 0;
    }
    note_rewind();
    publish(0);
  });
  return number;
}

std::shared_ptr<Session::Kept> Session::keep() {
  auto kept = std::make_shared<Kept>();
  enqueue([this, kept] {
    kept->moment = world_->moment();
    kept->keyframes = keyframes_;
    kept->keyframes.keep(*world_);
    kept->bytes = kept->moment.snapshot.size();
  });
  return kept;
}

size_t Session::bytes(const Kept& moment) {
  return moment.bytes;
}

void Session::restore(std::shared_ptr<const Kept> kept) {
  interrupt([this, kept = std::move(kept)] {
    if (auto status = world_->restore(kept->moment); !status) return fail(status.error());
    keyframes_ = kept->keyframes;
    if (second_) second_->begin(*world_, catch_up_slice);
    note_rewind();
    publish(0);
  });
}

std::shared_ptr<const Session::Way> Session::way() {
  auto way = std::make_shared<Way>();
  enqueue([this, way] {
    way->world = world_->save();
    way->log = world_->replay_log();
    way->keyframes = keyframes_;
    way->tick = world_->tick();
    way->filled = true;
  });
  return way;
}

std::optional<std::pair<uint64_t, uint64_t>> Session::ticks_of(const Way& way) {
  if (!way.filled) return std::nullopt;
  return std::pair(way.keyframes.first_tick(), way.tick);
}

Status Session::go(const Way& way, uint64_t from, const StopFlag& stop,
                   const std::function<bool(const World&)>& each) {
  WorldDef def;
  def.threads = 1;  // the other cores are left to the running world
  auto made = World::create(std::move(def));
  if (!made) return made.error();
  World& world = **made;
  world.stop_with(&stop);
  if (const Status done = world.load(way.world); !done) return done;
  // The same moment, but with the log of the run to be followed.
  if (const Status done = world.restore({world.save(false), way.log}); !done) return done;
  return way.keyframes.walk(world, from, each);
}

SessionView Session::view() {
  const Published& p = published_.latest();
  double s = 1;
  if (p.span > 0) s = std::clamp(Seconds(Clock::now() - p.at).count() / p.span, 0.0, 1.0);
  return {p.from, p.to, s, p.generation, p.world, p.before};
}

SessionCounters Session::counters() const {
  std::lock_guard lock(mutex_);
  SessionCounters now = counters_;
  if (under_way_since_) now.under_way_seconds = Seconds(Clock::now() - *under_way_since_).count();
  if (asking_since_) now.asking_seconds = Seconds(Clock::now() - *asking_since_).count();
  return now;
}

std::optional<Error> Session::fault() const {
  std::lock_guard lock(mutex_);
  return fault_;
}

Status Session::advance(uint64_t ticks) {
  run_posted();
  for (uint64_t i = 0; i < ticks; ++i) {
    if (auto status = step_once(); !status) return status;
    run_posted();
  }
  // Without a thread of its own there is nobody to go on later.
  if (second_) second_->follow(*world_);
  publish(0);
  return {};
}

void Session::go_to(uint64_t tick) {
  uint64_t seeks = 0;
  {
    std::lock_guard lock(mutex_);
    fault_.reset();
    seeks = seeks_asked_;
    counters_.way_to = tick;
  }
  tick = std::max(tick, keyframes_.first_tick());
  if (tick < world_->tick()) {
    std::shared_ptr<const Frame> before;
    const Status found = timed([&] { return keyframes_.seek(*world_, tick, &before); });
    if (!found) fail(found.error());
    // Later jumps to this tick, e.g. by loops, need not compute it again.
    if (found && keyframes_.last_tick() < world_->tick()) keyframes_.keep(*world_);
    if (second_) second_->go_back(*world_, catch_up_slice);
    note_rewind();
    before_ = before;
  } else {
    while (world_->tick() < tick) {
      if (auto status = step_once(); !status) {
        fail(status.error());
        break;
      }
      std::lock_guard lock(mutex_);
      if (quit_ || interrupts_ > 0 || seeks_asked_ != seeks) break;
    }
  }
  {
    std::lock_guard lock(mutex_);
    counters_.way_to = 0;
  }
  previous_ = world_->frame();
  publish(0);
}

Session::Search Session::go_until(const Found& found, double end) {
  {
    std::lock_guard lock(mutex_);
    fault_.reset();
    counters_.searching = true;
  }
  Search out = Search::nothing;
  while (out == Search::nothing && world_->time() < end) {
    if (auto status = step_once(); !status) {
      fail(status.error());
      out = Search::left;
      break;
    }
    if (found(*previous_, *world_->frame())) {
      out = Search::found;
      break;
    }
    std::lock_guard lock(mutex_);
    if (quit_ || !posted_.empty() || !counters_.paused) out = Search::left;
  }
  {
    std::lock_guard lock(mutex_);
    counters_.searching = false;
  }
  previous_ = world_->frame();
  publish(0);
  return out;
}

void Session::note_rewind() {
  ++generation_;
  (void)follow_replay(true);
  previous_ = world_->frame();
  before_.reset();
  for (const auto& watcher : watchers_) watcher->go_to(*previous_);
  next_due_ = Clock::now();
  rate_since_ = next_due_;
  rate_ticks_ = 0;
  std::lock_guard lock(mutex_);
  counters_.tick = world_->tick();
  counters_.time = world_->time();
  counters_.first_tick = keyframes_.first_tick();
  counters_.keyframe_bytes = keyframes_.bytes();
}

void Session::fail(const Error& error) {
  if (error.code == ErrorCode::cancelled) return;  // cancelled on request
  std::lock_guard lock(mutex_);
  fault_ = error;
  counters_.paused = true;
}

bool Session::run_posted() {
  std::deque<std::function<void()>> work;
  {
    std::lock_guard lock(mutex_);
    work.swap(posted_);
  }
  for (const auto& job : work) job();
  return !work.empty();
}

Status Session::follow_replay(bool anew) {
  return replay_ ? replay_->follow(*world_, anew) : Status();
}

Status Session::step_once() {
  const auto start = Clock::now();
  previous_ = world_->frame();
  const bool level = second_ && !second_->behind(*world_);
  const auto report = timed([&] { return world_->step(); });
  if (!report) return report.error();
  if (Status done = follow_replay(); !done) return done;
  before_ = previous_;
  keyframes_.after_step(*world_);
  if (second_) second_->follow(*world_, level ? no_limit : catch_up_slice);
  for (const auto& watcher : watchers_) watcher->see(*world_->frame());
  const auto end = Clock::now();
  const double spent = Seconds(end - start).count();
  ++rate_ticks_;
  const double window = Seconds(end - rate_since_).count();

  std::lock_guard lock(mutex_);
  counters_.tick = world_->tick();
  counters_.time = world_->time();
  counters_.tick_seconds +=
      counters_.tick_seconds == 0 ? spent : 0.1 * (spent - counters_.tick_seconds);
  counters_.keyframe_bytes = keyframes_.bytes();
  counters_.first_tick = keyframes_.first_tick();
  if (window >= 0.5) {
    counters_.ticks_per_second = double(rate_ticks_) / window;
    rate_since_ = end;
    rate_ticks_ = 0;
  }
  return {};
}

void Session::publish(double span) {
  published_.publish({span > 0 ? previous_ : world_->frame(), world_->frame(), next_due_, span,
                      generation_, world_number_, before_});
}

void Session::run() {
  next_due_ = rate_since_ = Clock::now();
  while (true) {
    // It is compared at moments that both have: A waits for B, and everybody else for neither.
    const bool catching_up = second_ && second_->behind(*world_);
    {
      std::unique_lock lock(mutex_);
      if (catching_up) {
        next_due_ = rate_since_ = Clock::now();
        rate_ticks_ = 0;
      } else if (counters_.paused && !quit_ && posted_.empty()) {
        wake_.wait(lock, [this] { return quit_ || !counters_.paused || !posted_.empty(); });
        next_due_ = rate_since_ = Clock::now();
        rate_ticks_ = 0;
      } else if (!counters_.paused) {
        wake_.wait_until(lock, next_due_, [this] { return quit_ || !posted_.empty(); });
      }
      if (quit_) return;
    }
    run_posted();
    if (catching_up) {
      if (second_) second_->follow(*world_, catch_up_slice);
      continue;
    }
    double span = 0;
    {
      std::lock_guard lock(mutex_);
      if (counters_.paused || Clock::now() < next_due_) continue;
      span = world_->settings().tick.tick() / counters_.speed;
    }
    if (auto status = step_once(); !status) {
      fail(status.error());
      previous_ = world_->frame();
      publish(0);
      continue;
    }
    // The new frame is due one span after the one before it: motion is shown one tick late, so that
    // it is always interpolated between two known frames.
    publish(span);
    next_due_ += to_clock(span);
    const double late = Seconds(Clock::now() - next_due_).count();
    std::lock_guard lock(mutex_);
    counters_.behind = late > most_behind;
    if (counters_.behind) {
      counters_.dropped_seconds += late;
      next_due_ = Clock::now();
    }
  }
}

}  // namespace tumble
