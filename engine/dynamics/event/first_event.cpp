#include "engine/dynamics/event/first_event.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
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
  for (double probe = step / tolerances::looks_per_step; probe > tolerances::least_probe * step;
       probe *= tolerances::probe_factor) {
    place_at(t + probe);
    w.lo = probe;
    w.value = w.value_now();
    if (w.value > away) break;
  }
  place_at(t);
  if (w.value > away || hop == 0) return;
  // It never gets that far away: then it counts as back where it overlaps by more than `more`.
  const double more = hop - std::min(start, 0.0);
  w = {[value_now = w.value_now, more] { return value_now() + more; }, 0, start + more};
}

/// Limits of joints that are reached; motors and friction whose rate is.
void FirstEvent::watch_drives(double t, double step, std::vector<ValueWatch>& watched) {
  for (const DrivePart& p : state_.system.drives().parts()) {
    if (p.holds) continue;
    const auto value = [this, &p] {
      const EventDrives& drives = state_.system.drives();
      const double now = state_.system.now();
      return p.limit() ? drives.room(p, state_.bodies, now)
                       : p.side * drives.rate_off(p, state_.bodies, now);
    };
    ValueWatch& w = watched.emplace_back(ValueWatch{value, 0, value(), nullptr});
    if (p.limit() && w.value <= tolerances::touch_distance)
      let_part(t, step, tolerances::place_rounding, w);
  }
}

/// Rolling and spinning that ends.
void FirstEvent::watch_turning(std::vector<ValueWatch>& watched) {
  for (const TurningPart& p : state_.system.turning()) {
    const auto now = [this, &p] { return turning_of(p, state_.contacts, state_.bodies); };
    const auto watch = [&](const std::function<double()>& value) {
      watched.push_back({value, 0, value(), nullptr});
    };
    if (p.rolls()) watch([now, &p] { return now().rolling.dot(p.axis); });
    if (p.spin != 0) watch([now, &p] { return p.spin * now().spinning; });
  }
}

double FirstEvent::find(double t, double step) {
  std::vector<ValueWatch> watched;
  stopping_ = nullptr;
  place_at(t);
  watch_drives(t, step, watched);
  watch_turning(watched);
  for (const EventPair& p : state_.pairs) {
    const double reach = tolerances::watched_reaches * reach_in(p, step);
    for (EventContact& c : state_.contacts_of(p)) {
      if (c.closed && !c.sliding) continue;
      const double value = event_value(c);
      if (!c.closed && value > reach) continue;
      ValueWatch& w = watched.emplace_back(
          ValueWatch{[this, &c] { return event_value(c); }, 0, value, c.closed ? &c : nullptr});
      const double hop = c.closed ? 0 : least_hop(place_now(c, state_.bodies).x_world);
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
      if (value > 0) {
        if (!found) w.lo = first, w.value = value;
        continue;
      }
      first = find_root(t, w.value_now, w.lo, w.value, first, value);
      found = true;
      stopping_ = w.slides;
      place_at(t + first);
    }
    const double touch = first_touch(t, lo, first, touching, tolerances::most_divisions);
    if (touch < first) stopping_ = nullptr;
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
      first = find_root(t, value, lo, w->room_passed(), until, room,
                        tolerances::touch_root_share * tolerances::deepest_unseen);
    }
  }
  if (!(first < never))
    for (TouchWatch* w : watched) w->pass();
  return first;
}

double FirstEvent::find_root(double t, const std::function<double()>& value, double lo, double f_lo,
                             double hi, double f_hi, double enough) {
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
  }
  return hi;
}

}  // namespace tumble
