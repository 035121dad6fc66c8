#pragma once
#include "engine/dynamics/event/group_state.hpp"
#include "engine/dynamics/event/touch_watch.hpp"
#include "engine/math/ode/integrator.hpp"

#include <functional>

namespace tumble {

/// Searches the last step of an integrator for its first event.
class FirstEvent {
 public:
  FirstEvent(GroupState& state, const ode::Integrator& integrator);

  /// The time of the first event after the start t of the step [s]; `step` if there is none.
  double find(double t, double step);

 private:
  /// Positive before the contact's next event: the gap that is left, or the slip along its
  /// direction.
  double event_value(const EventContact& contact) const;
  /// A value that is positive before an event and is sampled through the step.
  struct ValueWatch {
    std::function<double()> value_now;
    double lo, value;                ///< time up to which nothing happened, and the value then
    int traced = EventSearch::none;  ///< its index in the trace
  };
  void watch_drives(double t, double step, std::vector<ValueWatch>& watched);
  void watch_turning(std::vector<ValueWatch>& watched);
  /// A gap that has just opened must first exceed its value at the start by `hop` before it can
  /// close again.
  void let_part(double t, double step, double hop, ValueWatch& watch);
  /// Puts the bodies where the last step had them at time t.
  void place_at(double t);
  /// Upper bound on how much nearer the bodies of a pair may come in a step [m].
  double reach_in(const EventPair& pair, double step) const;
  /// The pieces that may come to touch in the last step, with the bodies where they are at its
  /// start t.
  std::vector<TouchWatch> watch_pieces(double t, double step);
  void set_motions(double t, double step, std::span<TouchWatch> watched);
  /// The first time in (lo, hi], since t, at which pieces are deeper than allowed; infinite if
  /// none. Everything watched must have been passed at `lo`. `depth`: how often the interval may
  /// still be halved.
  double first_touch(double t, double lo, double hi, std::span<TouchWatch* const> watched,
                     int depth);
  /// Root of a value at the bodies' places between times lo and hi since t, positive at lo. Returns
  /// a time at or after the root; stops early where the value is at least -enough.
  double find_root(double t, const std::function<double()>& value, double lo, double f_lo,
                   double hi, double f_hi, double enough = 0, int traced = EventSearch::none);

  /// Record the search, if it is traced.
  int trace_value(WatchedValue::Kind kind, uint32_t a, uint32_t b, const Vec3& x_world);
  void trace_look(int value, double time, double f, SearchLook::Stage stage, double low = 0,
                  double high = 0);
  void trace_found(double time, int value);

  GroupState& state_;
  const ode::Integrator& integrator_;
  std::vector<double> y_;
  EventSearchTrace* trace_ = nullptr;  ///< null unless the traced body belongs to this group
  EventSearch* search_ = nullptr;      ///< the present search in it
};

}  // namespace tumble
