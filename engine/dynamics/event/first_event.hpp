#pragma once
#include "engine/dynamics/event/group_state.hpp"
#include "engine/dynamics/event/touch_watch.hpp"
#include "engine/math/ode/integrator.hpp"

#include <functional>

namespace tumble {

/// The search for the first event in the last step of an integrator.
class FirstEvent {
 public:
  FirstEvent(GroupState& state, const ode::Integrator& integrator);

  /// Its time after the start of the step at t, or `step` when there is none.
  double find(double t, double step);

 private:
  /// Positive before the contact's next event: the room that is left, or the slip along itself.
  double event_value(const EventContact& contact) const;
  /// A value that is positive before an event.
  struct ValueWatch {
    std::function<double()> value_now;
    double lo, value;                ///< until when nothing happened, and the value there
    int traced = EventSearch::none;  ///< its place in the trace
  };
  void watch_drives(double t, double step, std::vector<ValueWatch>& watched);
  void watch_turning(std::vector<ValueWatch>& watched);
  /// What has just parted must first be away by more than `hop` before it can come back.
  void let_part(double t, double step, double hop, ValueWatch& watch);
  /// Puts the bodies where the last step had them at a time.
  void place_at(double t);
  /// How much nearer the bodies of a pair may come in a step [m].
  double reach_in(const EventPair& pair, double step) const;
  /// What may come to touch in the last step, at the bodies' places at t.
  std::vector<TouchWatch> watch_pieces(double t, double step);
  void set_motions(double t, double step, std::span<TouchWatch> watched);
  /// The first time between `lo` and `hi`, since t, at which pieces are deeper than allowed;
  /// infinite for none. All that is watched has passed `lo`.
  double first_touch(double t, double lo, double hi, std::span<TouchWatch* const> watched,
                     int depth);
  /// Of a value at the bodies' places between two times since t, positive at the first: the answer
  /// is at or behind it, where the value is no less than -enough.
  double find_root(double t, const std::function<double()>& value, double lo, double f_lo,
                   double hi, double f_hi, double enough = 0, int traced = EventSearch::none);

  /// For whoever looks; without one nothing is written.
  int trace_value(WatchedValue::Kind kind, uint32_t a, uint32_t b, const Vec3& x_world);
  void trace_look(int value, double time, double f, SearchLook::Stage stage, double low = 0,
                  double high = 0);
  void trace_found(double time, int value);

  GroupState& state_;
  const ode::Integrator& integrator_;
  std::vector<double> y_;
  EventSearchTrace* trace_ = nullptr;  ///< null where the body that is looked at is elsewhere
  EventSearch* search_ = nullptr;      ///< the present one in it
};

}  // namespace tumble
