#pragma once
#include "engine/core/result.hpp"
#include "engine/core/stop.hpp"
#include "engine/world/frame.hpp"
#include "engine/world/keyframes.hpp"
#include "engine/world/world_def.hpp"
#include "viewer/app/scenes/tick_watcher.hpp"
#include "viewer/app/session/triple_buffer.hpp"

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

namespace tumble {

class ReplayPlayer;
class SecondWorld;

struct SessionOptions {
  size_t keyframe_bytes = size_t{256} << 20;  ///< memory for stepping back
  uint64_t keyframe_ticks = 30;               ///< a keyframe every so many ticks
  bool paused = false;
  double speed = 1;                      ///< simulated seconds per real second
  TickWatchers watchers;                 ///< of this world
  std::shared_ptr<ReplayPlayer> replay;  ///< played into it; null: none
};

/// What a viewer shows: a moment between two frames of the same world.
struct SessionView {
  std::shared_ptr<const Frame> from, to;  ///< never null; equal when there is nothing between
  double s = 1;                           ///< 0: from, 1: to
  uint64_t generation = 0;  ///< changes when the world was replaced, restarted or stepped back
  uint64_t world = 0;       ///< which world: what replace() gave for it, 0 for the first
  std::shared_ptr<const Frame> before;  ///< of the tick before `to`; null: not known
};

/// How the simulation keeps up.
struct SessionCounters {
  uint64_t tick = 0;
  double time = 0;              ///< simulated [s]
  double tick_seconds = 0;      ///< wall time of a step, smoothed [s]
  double ticks_per_second = 0;  ///< steps per real second over the last half second
  double dropped_seconds = 0;   ///< real time given up because steps took too long [s]
  bool behind = false;          ///< dropping real time now
  bool paused = false;
  double speed = 1;
  size_t keyframe_bytes = 0;
  uint64_t first_tick = 0;  ///< how far stepping back reaches
  /// For how long the tick after `tick`, or the way to one that was asked for, has been under way
  /// [s]; 0 between two ticks.
  double under_way_seconds = 0;
  uint64_t way_to = 0;        ///< the tick that the session is on the way to; 0: on none
  std::string asking;         ///< the question to the world that is under way; "" for none
  double asking_seconds = 0;  ///< for how long it has been [s]
};

/// A world that runs: holds it with its keyframes and steps it, either on a simulation thread of
/// its own (start()) or on the caller's (advance()). The World is only ever touched by that one
/// thread; everything from outside goes through post() and call(), which run between two ticks, in
/// order. When steps take longer than real time the session drops real time, never ticks. What
/// leaves the present tick behind (another world, going back, the end) does not wait for it: the
/// tick is cancelled.
class Session {
 public:
  explicit Session(std::unique_ptr<World> world, SessionOptions options = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Starts the simulation thread; from then on it runs unless paused.
  void start();

  // -- any thread ---------------------------------------------------------------------------------
  /// Runs `change` on the world between two ticks; also while paused, and the view then shows it.
  void post(std::function<void(World&)> change);
  /// A question to the world that may take long, between two ticks; it changes nothing. Counters
  /// tell `what` is asked while it is under way. It is given up (Stoppable) for what leaves the
  /// present tick behind, and by cancel_question(): who asked learns that from stop_requested().
  void ask(std::string what, std::function<void(const World&)> question);
  /// Gives up the question that is under way, and nothing else.
  void cancel_question();
  /// The same, with an answer: `session.call([&](World& w) { return w.ray_cast(...); }).get()`.
  /// Takes at most one tick. Not from within a post or call.
  template <class F>
  std::future<std::invoke_result_t<F, World&>> call(F f) {
    using R = std::invoke_result_t<F, World&>;
    auto task = std::make_shared<std::packaged_task<R(World&)>>(std::move(f));
    auto answer = task->get_future();
    post([task](World& world) { (*task)(world); });
    return answer;
  }
  /// A second world that is stepped beside this one from now on, goes back with it, and begins anew
  /// where this one is restarted or put to a kept moment; null: none any more. Another world ends
  /// it.
  void set_second(std::shared_ptr<SecondWorld> second);
  void set_paused(bool paused);
  bool paused() const;
  /// Simulated seconds per real second, clamped to 1/1000 .. 1000.
  void set_speed(double speed);
  double speed() const;
  /// Pauses and moves by so many ticks; negative ones go back as far as the keyframes reach, from
  /// the last whole tick where the present one is slow.
  void step(int64_t ticks);
  /// Pauses at the last whole tick: the one under way is given up, and so is what waits for it.
  void cancel_tick();
  /// Pauses and goes on to the end of the first tick in which bodies strike each other: in which
  /// impulses acted (`event`), or two push each other that did not before. Gives up after so many
  /// simulated seconds, or when something else is asked for.
  void step_to_impact(double most_seconds);
  /// The same to the first tick of which `found` says so, from the frames before and after it.
  using Found = std::function<bool(const Frame& before, const Frame& after)>;
  void step_until(Found found, double most_seconds);
  /// Back to the first tick as it was before any change, and then changed by `begin`; runs on or
  /// stays paused as before.
  void restart(std::function<void(World&)> begin = {});
  /// Pauses and goes to a tick, forward or back. The next seek ends a way forward that is still
  /// under way.
  void seek(uint64_t tick);
  /// Exchanges the world for another (a new scene). Gives the number that its views carry: until
  /// the simulation thread gets to it, view() still shows the old one.
  uint64_t replace(std::unique_ptr<World> world, TickWatchers watchers = {},
                   std::shared_ptr<ReplayPlayer> replay = nullptr);
  /// The moment after all that was posted before, to come back to with restore(); of this world
  /// only. Filled on the simulation thread.
  struct Kept;
  std::shared_ptr<Kept> keep();
  /// Memory that a kept moment takes for itself; 0 until it is filled [bytes].
  static size_t bytes(const Kept& moment);
  /// Puts the world back to a kept moment, with the past that it had then: stepping back from it,
  /// and restart, go the way that led to it.
  void restore(std::shared_ptr<const Kept> moment);

  /// All that it takes to go the way to the present once more, elsewhere.
  struct Way;
  /// The way to the present of this world. Filled on the simulation thread.
  std::shared_ptr<const Way> way();
  /// The present that it leads to, and where it begins; nothing until it is filled.
  static std::optional<std::pair<uint64_t, uint64_t>> ticks_of(const Way& way);
  /// Goes a way, in a world of its own, on the caller's thread, from `from` on: `each` sees the
  /// world at every tick as it was left there, and says whether to go on. Error: a tick failed, or
  /// `stop` was requested.
  static Status go(const Way& way, uint64_t from, const StopFlag& stop,
                   const std::function<bool(const World&)>& each);

  // -- one reading thread -------------------------------------------------------------------------
  /// The two newest frames and where between them the present moment lies.
  SessionView view();
  SessionCounters counters() const;
  /// Why stepping stopped; the session is paused then. Cleared by the next step, restart, replace
  /// or by going on.
  std::optional<Error> fault() const;

  // -- without a simulation thread ----------------------------------------------------------------
  /// Steps on the calling thread, carrying out what was posted before each. Stops at the first
  /// failure. Only before start().
  Status advance(uint64_t ticks);
  /// The world itself; only before start().
  World& world() { return *world_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Published {
    std::shared_ptr<const Frame> from, to;
    Clock::time_point at;  ///< when `from` is due; `to` is due one span later
    double span = 0;       ///< real seconds between the two; 0: show `to`
    uint64_t generation = 0, world = 0;
    std::shared_ptr<const Frame> before;
  };

  void run();
  /// Carries out what was posted; true when something may have changed. Simulation thread.
  bool run_posted();
  Status step_once();
  Status follow_replay(bool anew = false);
  void publish(double span);
  void go_to(uint64_t tick);
  void go_until(const Found& found, double end);
  void fail(const Error& error);
  void note_rewind();
  /// Calls ticks() while everybody can see since when; within another one that one's time counts.
  /// Simulation thread.
  template <class Ticks>
  auto timed(const Ticks& ticks) {
    std::optional<Clock::time_point> before;
    {
      std::lock_guard lock(mutex_);
      before = under_way_since_;
      if (!before) under_way_since_ = Clock::now();
    }
    auto done = ticks();
    std::lock_guard lock(mutex_);
    under_way_since_ = before;
    return done;
  }
  /// Puts a job behind those that wait.
  void enqueue(std::function<void()> job);
  /// The same for a job that the tick under way, and ticks that wait before it, are given up for.
  void interrupt(std::function<void()> job);
  /// The same where the tick under way is slow, else enqueue().
  void interrupt_if_slow(std::function<void()> job);

  std::unique_ptr<World> world_;
  KeyframeRing keyframes_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> posted_;
  SessionCounters counters_;
  std::optional<Error> fault_;
  std::optional<Clock::time_point> under_way_since_;  ///< the present tick, or way to a tick
  StopFlag stop_;           ///< of the world; requested while any interrupt waits
  StopFlag stop_question_;  ///< of the question under way
  std::optional<Clock::time_point> asking_since_;
  int interrupts_ = 0;  ///< that wait
  bool quit_ = false;
  uint64_t worlds_asked_ = 0, seeks_asked_ = 0;

  // Simulation thread only.
  std::shared_ptr<SecondWorld> second_;
  TickWatchers watchers_;
  std::shared_ptr<ReplayPlayer> replay_;
  std::shared_ptr<const Frame> previous_;
  std::shared_ptr<const Frame> before_;  ///< of the tick before the world's; null: not known
  uint64_t generation_ = 1, world_number_ = 0;
  Clock::time_point next_due_;
  Clock::time_point rate_since_;
  uint64_t rate_ticks_ = 0;

  TripleBuffer<Published> published_;
  std::thread thread_;
};

}  // namespace tumble
