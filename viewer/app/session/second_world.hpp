#pragma once
#include "engine/core/stop.hpp"
#include "engine/world/keyframes.hpp"
#include "engine/world/settings.hpp"
#include "engine/world/world_def.hpp"
#include "viewer/app/verify/lockstep.hpp"

#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// World B of a comparison, which has other choices than A and receives the same commands. It
/// starts as a copy of A's state with other settings or, if its numbers make it a different scene,
/// as that scene at its first tick. A Session steps both on its thread; results can be read from
/// any thread.
class SecondWorld {
 public:
  explicit SecondWorld(WorldChoice choice) : choice_(std::move(choice)) {}
  /// World B for a scene with other numbers; `made` is that scene at its first tick.
  SecondWorld(WorldChoice choice, const World& made);

  // -- simulation thread --------------------------------------------------------------------------
  static constexpr double no_limit = std::numeric_limits<double>::infinity();
  /// B becomes what A is now, with its own settings, or begins at its own first tick and catches
  /// up. A failure is shown, and stops B.
  void begin(const World& a, double seconds = no_limit);
  /// Carries out what was done to A since, but for settings, and steps B up to A's moment, or, by
  /// one tick at least, for so long: then it is still behind.
  void follow(const World& a, double seconds = no_limit);
  /// A has gone back on its own course: B goes with it, or begins anew where it was not there yet.
  void go_back(const World& a, double seconds = no_limit);
  /// B has not come to A's moment yet, and can.
  bool behind(const World& a) const;
  void stop_with(const StopFlag* flag);

  // -- any thread ---------------------------------------------------------------------------------
  struct Sample {
    double time = 0, distance = 0;  ///< [s], [m]
  };
  struct Shown {
    std::shared_ptr<const Frame> from, to;  ///< of B, for A's frames at these ticks
    uint64_t tick_from = 0, tick_to = 0;    ///< of A
    std::vector<Sample> samples;      ///< at the latest times that both have reached, oldest first
    std::optional<Divergence> first;  ///< the first tick at which any bit differs
    std::optional<ContactDifference> first_contact;  ///< the first contact that differs
    bool alone = false;  ///< B has other bodies: commands to A are not applied to it
    Divergence now, worst;
    std::string fault;  ///< why B stopped; empty: it did not
    double behind = 0;  ///< how far it is from A's moment while it catches up [s]
  };
  Shown shown() const;
  const WorldChoice& choice() const { return choice_; }
  bool from_start() const { return !origin_.empty(); }

 private:
  /// The time that A has run since the comparison began, in ticks of B.
  double ticks_of_b(const World& a) const;
  void carry_out(const World& a, double until);
  void see(const World& a);
  void fail(const std::string& why);

  Status make(const World& a);

  WorldChoice choice_;
  Bytes origin_;  ///< snapshot of B's own first tick; empty if B started as a copy of A
  std::unique_ptr<World> world_;
  KeyframeRing keyframes_;
  const StopFlag* stop_ = nullptr;
  uint64_t begun_a_ = 0, begun_b_ = 0;  ///< ticks of both at the beginning
  size_t commands_ = 0;                 ///< of A's log that were carried out
  bool failed_ = false;                 ///< nothing more comes of it until it begins anew

  mutable std::mutex mutex_;
  Shown shown_;
};

}  // namespace tumble
