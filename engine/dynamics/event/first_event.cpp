#include "engine/dynamics/event/first_event.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

FirstEvent::FirstEvent(GroupState& state, const ode::Integrator& integrator)
    : state_(state), integrator_(integrator), y_(state.system.size()) {
  EventSearchTrace* asked = state.context.search;
  const std::vector<uint32_t>& bodies = state.group.bodies;
  if (asked && std::binary_search(bodies.begin(), bodies.end(), asked->body)) trace_ = asked;
}

int FirstEvent::trace_value(WatchedValue::Kind kind, uint32_t a, uint32_t b, const Vec3& x_world) {
  if (!search_) return EventSearch::none;
  search_->watched.push_back({kind, a, b, x_world});
  return int(search_->watched.size()) - 1;
}

void FirstEvent::trace_look(int value, double time, double f, SearchLook::Stage stage, double low,
                            double high) {
  if (search_ && value != EventSearch::none)
    search_->looks.push_back(
        {time, uint32_t(value), f, stage, low, high, state_.bodies[trace_->body].pose});
}

void FirstEvent::trace_found(double time, int value) {
  if (!search_) return;
  search_->found = time;
  search_->first = value;
}

double FirstEvent::event_value(const EventContact& c) const {
  const ElementPlace g = push_place(c, state_.bodies);
  return c.closed ? slip_of(c, g, state_.bodies).dot(c.slip) : c.room(g);
}

void FirstEvent::place_at(double t) {
  charge_work(prices::place, state_.group.bodies.size());
  integrator_.at(state_.system, t, y_);
  state_.system.write(t, y_);
}

void FirstEvent::let_part(double t, double step, double hop, ValueWatch& w) {
  const double start = w.value, away = std::max(start, 0.0) + hop;
  for (double probe = step / tolerances::looks_per_step;
       probe > tolerances::least_probe * step && !stop_requested();
       probe *= tolerances::probe_factor) {
    place_at(t + probe);
    w.lo = probe;
    w.value = w.value_now();
    trace_look(w.traced, probe, w.value, SearchLook::Stage::parted);
    if (w.value > away) break;
  }
  place_at(t);
  if (w.value > away || hop == 0) return;
  // The gap never grows that much: the contact then closes again once it overlaps by more than
  // `more`.
  const double more = hop - std::min(start, 0.0);
  w = {[value_now = w.value_now, more] { return value_now() + more; }, 0, start + more, w.traced};
}

/// Watches limits of joints that may be reached, and motors and friction whose rate may be.
void FirstEvent::watch_drives(double t, double step, std::vector<ValueWatch>& watched) {
  for (const DrivePart& p : state_.system.drives().parts()) {
    if (p.holds) continue;
    const auto value = [this, &p] {
      const EventDrives& drives = state_.system.drives();
      const double now = state_.system.now();
      return p.limit() ? drives.room(p, state_.bodies, now)
                       : p.side * drives.rate_off(p, state_.bodies, now);
    };
    ValueWatch& w = watched.emplace_back(ValueWatch{value, 0, value()});
    w.traced = trace_value(p.limit() ? WatchedValue::Kind::limit : WatchedValue::Kind::rate,
                           no_body, no_body, Vec3::Zero());
    trace_look(w.traced, 0, w.value, SearchLook::Stage::start);
    if (p.limit() && w.value <= tolerances::touch_distance)
      let_part(t, step, tolerances::place_rounding, w);
  }
}

/// Watches for the end of rolling and spinning.
void FirstEvent::watch_turning(std::vector<ValueWatch>& watched) {
  for (const TurningPart& p : state_.system.turning()) {
    const auto now = [this, &p] { return turning_of(p, state_.contacts, state_.bodies); };
    const auto watch = [&](WatchedValue::Kind kind, const std::function<double()>& value) {
      ValueWatch& w = watched.emplace_back(ValueWatch{value, 0, value()});
      if (!search_) return;
      const EventContact& c = state_.contacts[p.contacts[0]];
      w.traced = trace_value(kind, c.key.body_a, c.key.body_b, place_now(c, state_.bodies).x_world);
      trace_look(w.traced, 0, w.value, SearchLook::Stage::start);
    };
    if (p.rolls())
      watch(WatchedValue::Kind::rolling, [now, &p] { return now().rolling.dot(p.axis); });
    if (p.spin != 0)
      watch(WatchedValue::Kind::spinning, [now, &p] { return p.spin * now().spinning; });
  }
}

double FirstEvent::find(double t, double step) {
  std::vector<ValueWatch> watched;
  search_ = trace_ ? trace_->begin(t, step) : nullptr;
  place_at(t);
  watch_drives(t, step, watched);
  watch_turning(watched);
  for (const EventPair& p : state_.pairs) {
    const double reach = tolerances::watched_reaches * reach_in(p, step);
    for (EventContact& c : state_.contacts_of(p)) {
      if (stop_requested()) return step;
      if (c.closed && !c.sliding) continue;
      const double value = event_value(c);
      if (!c.closed && value > reach) continue;
      ValueWatch& w =
          watched.emplace_back(ValueWatch{[this, &c] { return event_value(c); }, 0, value});
      const Vec3 x =
          c.closed && !search_ ? Vec3(Vec3::Zero()) : place_now(c, state_.bodies).x_world;
      w.traced = trace_value(c.closed ? WatchedValue::Kind::slip : WatchedValue::Kind::gap,
                             c.key.body_a, c.key.body_b, x);
      trace_look(w.traced, 0, w.value, SearchLook::Stage::start);
      const double hop = c.closed ? 0 : least_hop(x);
      if (w.value <= (c.closed ? 0 : tolerances::touch_distance)) let_part(t, step, hop, w);
    }
  }
  std::vector<TouchWatch> pieces = watch_pieces(t, step);
  if (watched.empty() && pieces.empty()) return step;
  std::vector<TouchWatch*> touching;
  for (TouchWatch& w : pieces) touching.push_back(&w);
  for (int k = 1; k <= tolerances::looks_per_step && !stop_requested(); ++k) {
    const double lo = step * (k - 1) / tolerances::looks_per_step;
    double first = step * k / tolerances::looks_per_step;
    bool found = false;
    place_at(t + first);
    for (ValueWatch& w : watched) {
      if (!(w.value > 0) || w.lo >= first) continue;
      charge_work(prices::gap);
      const double value = w.value_now();
      trace_look(w.traced, first, value, SearchLook::Stage::look, w.lo, first);
      if (value > 0) {
        if (!found) w.lo = first, w.value = value;
        continue;
      }
      first = find_root(t, w.value_now, w.lo, w.value, first, value, 0, w.traced);
      found = true;
      trace_found(first, w.traced);
      place_at(t + first);
    }
    const double touch = first_touch(t, lo, first, touching, tolerances::most_divisions);
    if (found || touch < first) return std::min(first, touch);
  }
  return step;
}

double FirstEvent::reach_in(const EventPair& p, double step) const {
  const RigidBody &a = state_.bodies[p.a.body], &b = state_.bodies[p.b.body];
  return tolerances::reach_spare * step * (speed_bound(a, step) + speed_bound(b, step)) +
         tolerances::deepest_dip;
}

std::vector<TouchWatch> FirstEvent::watch_pieces(double t, double step) {
  std::vector<TouchWatch> out;
  std::vector<PiecePair> pieces;
  std::vector<Vec3> normals;
  for (const EventPair& p : state_.pairs) {
    charge_work(prices::pair);
    const double reach = reach_in(p, step);
    if (p.gap.gap > reach) continue;
    normals.clear();
    for (const EventContact& c : state_.contacts_of(p)) {
      const ElementPlace g = place_now(c, state_.bodies);
      if (g.regular) normals.push_back(g.normal);
    }
    if (p.gap.near) normals.push_back(p.gap.normal);
    pieces_of_pair(p, state_.bodies, reach, state_.context.hierarchy, pieces);
    for (const PiecePair& piece : pieces) {
      if (stop_requested()) return {};
      out.emplace_back(p, piece, state_.bodies, normals, reach);
      if (!out.back().near()) out.pop_back();
    }
  }
  set_motions(t, step, out);
  return out;
}

void FirstEvent::set_motions(double t, double step, std::span<TouchWatch> watched) {
  std::vector<SwingMotion> start;
  std::vector<size_t> first;
  for (size_t i = 0; i < watched.size(); ++i) {
    const EventPair& p = watched[i].pair();
    if (i > 0 && &p == &watched[i - 1].pair()) continue;
    first.push_back(i);
    for (const uint32_t slot : {p.a.body, p.b.body}) start.emplace_back(state_.bodies[slot]);
  }
  place_at(t + step);
  for (size_t k = 0; k < first.size(); ++k) {
    const EventPair& p = watched[first[k]].pair();
    const RelativeMotion motion(start[2 * k], start[2 * k + 1],
                                SwingMotion(state_.bodies[p.a.body]),
                                SwingMotion(state_.bodies[p.b.body]), step);
    const size_t end = k + 1 < first.size() ? first[k + 1] : watched.size();
    for (size_t i = first[k]; i < end; ++i) watched[i].set_motion(motion);
  }
}

double FirstEvent::first_touch(double t, double lo, double hi, std::span<TouchWatch* const> watched,
                               int depth) {
  constexpr double never = std::numeric_limits<double>::infinity();
  std::vector<TouchWatch*> open, touched;
  if (watched.empty()) return never;
  place_at(t + hi);
  for (TouchWatch* w : watched) {
    if (stop_requested()) return never;
    const TouchWatch::Look found = w->look(state_.bodies, hi - lo);
    if (found == TouchWatch::Look::clear) continue;
    (found == TouchWatch::Look::open && depth > 0 ? open : touched).push_back(w);
  }
  double first = never;
  if (!open.empty()) {
    open.insert(open.end(), touched.begin(), touched.end());
    const double mid = 0.5 * (lo + hi);
    first = first_touch(t, lo, mid, open, depth - 1);
    if (!(first < never)) first = first_touch(t, mid, hi, open, depth - 1);
  } else {
    for (const TouchWatch* w : touched) {
      const double until = std::min(first, hi);
      place_at(t + until);
      const double room = w->room_now(state_.bodies);
      if (room > 0) continue;
      const auto value = [this, w] { return w->room_now(state_.bodies); };
      const EventPair& p = w->pair();
      const int traced = trace_value(WatchedValue::Kind::pieces, p.a.body, p.b.body,
                                     0.5 * (p.gap.on_a + p.gap.on_b));
      trace_look(traced, lo, w->room_passed(), SearchLook::Stage::look, lo, lo);
      trace_look(traced, until, room, SearchLook::Stage::look, lo, until);
      first = find_root(t, value, lo, w->room_passed(), until, room,
                        tolerances::touch_root_share * tolerances::deepest_unseen, traced);
      trace_found(first, traced);
    }
  }
  if (!(first < never))
    for (TouchWatch* w : watched) w->pass();
  return first;
}

double FirstEvent::find_root(double t, const std::function<double()>& value, double lo, double f_lo,
                             double hi, double f_hi, double enough, int traced) {
  const double tiny = tolerances::root_accuracy * hi;
  for (int n = 0;
       n < tolerances::most_root_steps && hi - lo > tiny && f_hi < -enough && !stop_requested();
       ++n) {
    double mid = lo + (hi - lo) * f_lo / (f_lo - f_hi);
    if (!(mid > lo && mid < hi)) mid = 0.5 * (lo + hi);
    place_at(t + mid);
    const double f = value();
    if (f > 0) {
      lo = mid, f_lo = f, f_hi *= 0.5;
    } else {
      hi = mid, f_hi = f, f_lo *= 0.5;
    }
    trace_look(traced, mid, f, SearchLook::Stage::root, lo, hi);
  }
  return hi;
}

}  // namespace tumble
