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
  /// Memory for keyframes, which allow stepping back [bytes].
  size_t keyframe_bytes = size_t{256} << 20;
  uint64_t keyframe_ticks = 30;  ///< ticks from one keyframe to the next
  bool paused = false;
  double speed = 1;                      ///< simulated seconds per real second
  TickWatchers watchers;                 ///< of this world
  std::shared_ptr<ReplayPlayer> replay;  ///< replay to play into the world; null: none
};

/// The moment to show, between two frames of the same world.
struct SessionView {
  std::shared_ptr<const Frame> from, to;  ///< never null; equal if there is nothing to interpolate
  double s = 1;                           ///< fraction of the way from `from` (0) to `to` (1)
  uint64_t generation = 0;  ///< changes when the world is replaced, restarted or set back in time
  uint64_t world = 0;       ///< number of the world: that returned by replace(), 0 for the first
  std::shared_ptr<const Frame> before;  ///< of the tick before `to`; null: not known
};

/// State and speed of the simulation.
struct SessionCounters {
  uint64_t tick = 0;
  double time = 0;              ///< simulated [s]
  double tick_seconds = 0;      ///< wall time of a step, smoothed [s]
  double ticks_per_second = 0;  ///< steps per real second over the last half second
  double dropped_seconds = 0;   ///< real time skipped because steps took too long [s]
  bool behind = false;          ///< real time is being skipped now
  bool paused = false;
  double speed = 1;
  size_t keyframe_bytes = 0;
  uint64_t first_tick = 0;  ///< earliest tick that can be reached by stepping back
  /// How long the tick after `tick`, or a seek to another tick, has been under way [s]; 0 between
  /// two ticks.
  double under_way_seconds = 0;
  uint64_t way_to = 0;        ///< target of the seek under way; 0: none
  bool searching = false;     ///< a search for something that happens is under way
  std::string asking;         ///< description of the query under way; "": none
  double asking_seconds = 0;  ///< how long that query has been under way [s]
};

/// Owns a running world with its keyframes, and steps it on a simulation thread of its own
/// (start()) or on the caller's (advance()). Only that one thread accesses the World; everything
/// else goes through post() and call(), whose jobs run in order between two ticks. If steps take
/// longer than real time, the session skips real time, never ticks. Requests that make the tick
/// under way irrelevant (another world, going back, the end) do not wait for it: the tick is
/// cancelled.
class Session {
 public:
  explicit Session(std::unique_ptr<World> world, SessionOptions options = {});
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Starts the simulation thread; from then on it runs unless paused.
  void start();

  // -- any thread ---------------------------------------------------------------------------------
  // Runs `change` on the world between two ticks, also while paused. The view then shows the
  // result.
  void post(std::function<void(World&)> change);
  /// Runs a query that may take long between two ticks; it must not change the world. While it is
  /// under way, the counters report `what`. It is cancelled (Stoppable) by requests that make the
  /// present tick irrelevant and by cancel_question(); the query learns of that by
  /// stop_requested().
  void ask(std::string what, std::function<void(const World&)> question);
  /// Cancels only the query under way.
  void cancel_question();
  /// Runs `f` like post() and returns its result: `session.call([&](World& w) { return
  /// w.ray_cast(...); }).get()`. Waits for at most one tick. Must not be called from within a
  /// post() or call().
  template <class F>
  std::future<std::invoke_result_t<F, World&>> call(F f) {
    using R = std::invoke_result_t<F, World&>;
    auto task = std::make_shared<std::packaged_task<R(World&)>>(std::move(f));
    auto answer = task->get_future();
    post([task](World& world) { (*task)(world); });
    return answer;
  }
  /// Sets a second world, to be stepped beside this one: it follows when this world goes back, and
  /// starts anew when this world is restarted or restored. Null removes it, and so does replace().
  void set_second(std::shared_ptr<SecondWorld> second);
  void set_paused(bool paused);
  bool paused() const;
  /// Simulated seconds per real second, clamped to 1/1000 .. 1000.
  void set_speed(double speed);
  double speed() const;
  /// Pauses and moves by a number of ticks. Negative numbers go back as far as the keyframes reach;
  /// if the tick under way is slow, it is cancelled and the steps are counted from the last
  /// complete tick.
  void step(int64_t ticks);
  /// Pauses at the last complete tick; the tick under way and all jobs waiting for it are
  /// cancelled.
  void cancel_tick();
  /// Pauses and steps to the end of the first tick with an impact: one with impulses (`event`
  /// stepper), or in which two bodies press on each other that did not before. Gives up after
  /// `most_seconds` of simulated time, or when something else is requested.
  void step_to_impact(double most_seconds);
  /// Steps in the same way to the first tick for which `found` returns true, given the frames
  /// before and after it.
  using Found = std::function<bool(const Frame& before, const Frame& after)>;
  /// How such a search ends; `left`: something else was requested.
  enum class Search : uint8_t { found, nothing, left };
  std::future<Search> step_until(Found found, double most_seconds);
  /// Goes back to the first tick in its original state, then applies `begin`; running or paused as
  /// before.
  void restart(std::function<void(World&)> begin = {});
  /// Pauses and goes to a tick, forward or back. A later seek ends one that is still under way.
  void seek(uint64_t tick);
  /// Replaces the world (for a new scene). Returns the number that its views will carry; until the
  /// simulation thread has replaced the world, view() shows the old one.
  uint64_t replace(std::unique_ptr<World> world, TickWatchers watchers = {},
                   std::shared_ptr<ReplayPlayer> replay = nullptr);
  /// A snapshot of the moment after all jobs posted before, for restore() into the same world. The
  /// simulation thread fills it.
  struct Kept;
  std::shared_ptr<Kept> keep();
  /// Memory that only this snapshot uses (keyframes are shared); 0 until it is filled [bytes].
  static size_t bytes(const Kept& moment);
  /// Restores a snapshot, including its past: stepping back and restart then follow the history of
  /// the snapshot.
  void restore(std::shared_ptr<const Kept> moment);

  /// Everything needed to recompute the run up to the present in another world.
  struct Way;
  /// The way to the present of this world. The simulation thread fills it.
  std::shared_ptr<const Way> way();
  /// Last and first tick of a way; empty until it is filled.
  static std::optional<std::pair<uint64_t, uint64_t>> ticks_of(const Way& way);
  /// Recomputes a run from tick `from` on, in a world of its own on the calling thread. `each` is
  /// called with the world at every tick, after the commands of that tick, and returns whether to
  /// go on. Error: a tick failed, or `stop` was requested.
  static Status go(const Way& way, uint64_t from, const StopFlag& stop,
                   const std::function<bool(const World&)>& each);

  // -- one reading thread -------------------------------------------------------------------------
  // The two newest frames, and the fraction of the way between them that is to be shown now.
  SessionView view();
  SessionCounters counters() const;
  /// Why stepping stopped; the session is then paused. Cleared by the next step, restart, replace
  /// or resume.
  std::optional<Error> fault() const;

  // -- without a simulation thread ----------------------------------------------------------------
  // Steps on the calling thread; before each tick the posted jobs run. Stops at the first failure.
  // Only before start().
  Status advance(uint64_t ticks);
  /// The world itself; only before start().
  World& world() { return *world_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Published {
    std::shared_ptr<const Frame> from, to;
    Clock::time_point at;  ///< when `from` is due; `to` is due `span` later
    double span = 0;       ///< real time between the two [s]; 0: show `to`
    uint64_t generation = 0, world = 0;
    std::shared_ptr<const Frame> before;
  };

  void run();
  /// Runs the posted jobs; true if something may have changed. Simulation thread.
  bool run_posted();
  Status step_once();
  Status follow_replay(bool anew = false);
  void publish(double span);
  void go_to(uint64_t tick);
  Search go_until(const Found& found, double end);
  void fail(const Error& error);
  void note_rewind();
  /// Calls ticks() and publishes the start time meanwhile; nested calls keep that of the outermost
  /// one. Simulation thread.
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
  /// Appends a job to the queue.
  void enqueue(std::function<void()> job);
  /// The same for a job that cancels the tick under way and all ticks waiting before it.
  void interrupt(std::function<void()> job);
  /// Like interrupt() if the tick under way is slow, otherwise like enqueue().
  void interrupt_if_slow(std::function<void()> job);

  std::unique_ptr<World> world_;
  KeyframeRing keyframes_;

  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<std::function<void()>> posted_;
  SessionCounters counters_;
  std::optional<Error> fault_;
  std::optional<Clock::time_point> under_way_since_;  ///< start of the tick or seek under way
  StopFlag stop_;           ///< of the world; requested while any interrupting job waits
  StopFlag stop_question_;  ///< of the query under way
  std::optional<Clock::time_point> asking_since_;
  int interrupts_ = 0;  ///< number of interrupting jobs that wait
  bool quit_ = false;
  uint64_t worlds_asked_ = 0, seeks_asked_ = 0;

  // Simulation thread only.
  std::shared_ptr<SecondWorld> second_;
  TickWatchers watchers_;
  std::shared_ptr<ReplayPlayer> replay_;
  std::shared_ptr<const Frame> previous_;
  std::shared_ptr<const Frame> before_;  ///< frame of the tick before the world's; null: not known
  uint64_t generation_ = 1, world_number_ = 0;
  Clock::time_point next_due_;
  Clock::time_point rate_since_;
  uint64_t rate_ticks_ = 0;

  TripleBuffer<Published> published_;
  std::thread thread_;
};

}  // namespace tumble
