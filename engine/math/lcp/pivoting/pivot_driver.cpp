#include "engine/math/lcp/pivoting/pivot_driver.hpp"

#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/pivoting/block_start.hpp"
#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble::lcp {
namespace {

constexpr double endless = std::numeric_limits<double>::infinity();

/// The first t >= 0 at which |x + t dx| - slope (a + t da) becomes positive; endless if never.
double surface_time(double slope, double a, double da, std::array<double, 2> x,
                    std::array<double, 2> dx) {
  const double ra = slope * a, dr = slope * da;
  const double p = dx[0] * dx[0] + dx[1] * dx[1] - dr * dr;
  const double q = x[0] * dx[0] + x[1] * dx[1] - ra * dr;
  const double r = std::min(0.0, x[0] * x[0] + x[1] * x[1] - ra * ra);
  // p t^2 + 2 q t + r with r <= 0
  if (r == 0) return q > 0 || (q == 0 && p > 0) ? 0 : p > 0 ? -2 * q / p : endless;
  const double discriminant = q * q - p * r;
  if (discriminant < 0) return endless;
  const double root = std::sqrt(discriminant);
  if (q >= 0) return q + root > 0 ? -r / (q + root) : endless;
  return p > 0 ? (root - q) / p : endless;
}

PivotSet set_of(Role role, Place place) {
  switch (role) {
    case Role::clamped:
      return PivotSet::clamped;
    case Role::resting:
      return PivotSet::resting;
    case Role::tied:
      return PivotSet::tied;
    case Role::at_bound:
      break;
  }
  return place == Place::upper ? PivotSet::at_upper : PivotSet::at_lower;
}

}  // namespace

int PivotDriver::choose() const {
  int best = -1;
  double most = s_.tolerance();
  for (int i = 0; i < s_.n; ++i) {
    const double x = s_.wrong(i);
    if (!(x > most)) continue;
    if (least_index_) return i;
    most = x;
    best = i;
  }
  return best;
}

/// The greatest entry of A d relative to the length of d; entries of clamped unknowns are 0 up to
/// rounding.
double PivotDriver::change() const {
  double length = 0, most = 0;
  for (int i = 0; i < s_.n; ++i) {
    length += std::fabs(dz_[i]);
    if (!s_.is_clamped(i)) most = std::max(most, std::fabs(dw_[i]));
  }
  return most / length;
}

void PivotDriver::offer(Event event, int index, double room, double rate) {
  stops_.push_back({event, index, std::max(room, 0.0), rate});
}

void PivotDriver::collect_surfaces(const PivotState::Group& g) {
  const int a = g.cone.axial, i = g.cone.lateral[0], j = g.cone.lateral[1];
  if (dz_[a] < -tolerances::still) offer(Event::apex, a, s_.z[a], -dz_[a]);
  if (g.prescribed()) return;
  if (g.round()) {
    if (s_.role[size_t(i)] == Role::tied) return;
    const double t =
        surface_time(g.cone.slope, s_.z[a], dz_[a], {s_.z[i], s_.z[j]}, {dz_[i], dz_[j]});
    if (t < endless) offer(Event::surface, i, t, 1);
    return;
  }
  for (const int k : g.cone.lateral) {
    if (s_.role[size_t(k)] == Role::tied) continue;
    for (const double side : {1.0, -1.0}) {
      const double rate = side * dz_[k] - g.cone.slope * dz_[a];
      if (rate > tolerances::still)
        offer(Event::surface, k, g.cone.slope * s_.z[a] - side * s_.z[k], rate);
    }
  }
}

void PivotDriver::collect_slacks(int l) {
  const double tolerance = s_.tolerance();
  for (int i = 0; i < s_.n; ++i) {
    const auto k = size_t(i);
    if (i == l || s_.excused[k] || s_.wrong(i) > tolerance) continue;
    switch (s_.role[k]) {
      case Role::clamped:
        break;
      case Role::resting:
        if (std::fabs(dw_[i]) > tolerances::steady_resting)
          offer(Event::other_w, i, 0, std::fabs(dw_[i]));
        break;
      case Role::at_bound: {
        if (s_.is_lateral(i) || s_.is_fixed(i)) break;
        const double rate = s_.place[k] == Place::upper ? dw_[i] : -dw_[i];
        if (rate > tolerances::steady) offer(Event::other_w, i, std::fabs(s_.w[i]), rate);
        break;
      }
      case Role::tied: {
        const PivotState::Group& g = s_.group(i);
        const size_t axis = g.cone.lateral[0] == i ? 0 : 1;
        if (g.prescribed() || (g.round() && axis == 1)) break;
        const double rate = g.tie[axis] > 0 ? dw_[i] : -dw_[i];
        if (rate > tolerances::steady) offer(Event::inward, i, -s_.outward(i), rate);
        break;
      }
    }
  }
}

void PivotDriver::collect(int l, double sign, bool flat) {
  stops_.clear();
  if (!flat && sign * dw_[l] > 0) offer(Event::own_w, l, std::fabs(s_.w[l]), std::fabs(dw_[l]));
  const auto to_bound = [&](Event event, int i) {
    if (s_.grouped(i) || std::fabs(dz_[i]) <= tolerances::still) return;
    const double room = dz_[i] > 0 ? s_.problem.upper[i] - s_.z[i] : s_.z[i] - s_.problem.lower[i];
    if (room < endless) offer(event, i, room, std::fabs(dz_[i]));
  };
  to_bound(Event::own_bound, l);
  for (const int i : s_.members()) to_bound(Event::bound, i);
  for (const PivotState::Group& g : s_.groups)
    if (!g.open(s_) || g.cone.axial == l) collect_surfaces(g);
  if (!flat) collect_slacks(l);
}

/// The first stop. Of those that are equal up to rounding, the one with the greatest rate, which is
/// the safest pivot (Harris 1973); or, against cycling, the one with the least index.
PivotDriver::Stop PivotDriver::pick() const {
  const double slack = s_.tolerance();
  double reach = endless;
  for (const Stop& c : stops_) reach = std::min(reach, (c.room + slack) / c.rate);
  Stop out;
  double best = -1;
  for (const Stop& c : stops_) {
    if (c.step() > reach) continue;
    const bool own = c.event == Event::own_w || c.event == Event::own_bound;
    const double merit = own ? endless : least_index_ ? 1.0 / (1 + c.index) : c.rate;
    if (merit > best) {
      best = merit;
      out = c;
    }
  }
  return out;
}

void PivotDriver::meet_surface(int i, PivotState::Group& g) {
  const double slope = g.cone.slope;
  if (g.round()) {
    // At the apex the laterals leave in the direction of the motion.
    const int j = g.cone.lateral[1];
    if (std::fabs(s_.z[i]) + std::fabs(s_.z[j]) <= s_.tolerance()) s_.turn(g, dz_[i], dz_[j]);
    s_.tie_along_z(g);
    return;
  }
  const double out = std::fabs(s_.z[i]) > s_.tolerance() ? s_.z[i] : dz_[i];
  g.tie[g.cone.lateral[0] == i ? 0 : 1] = out > 0 ? slope : -slope;
  s_.role[size_t(i)] = Role::tied;
}

/// Changes roles; false if the motion of l has ended.
bool PivotDriver::apply(const Stop& stop, int l) {
  const int i = stop.index;
  PivotState::Group* g = s_.grouped(i) ? &s_.group(i) : nullptr;
  const bool of_own = g && s_.group_of[size_t(i)] == s_.group_of[size_t(l)];
  switch (stop.event) {
    case Event::own_w:
      s_.w[l] = 0;
      s_.enter_driven(l);
      return false;
    case Event::own_bound:
    case Event::bound:
      s_.leave(i, dz_[i] > 0 ? Place::upper : Place::lower);
      return stop.event == Event::bound;
    case Event::apex:
      s_.open(*g);
      return !of_own;
    case Event::surface:
      meet_surface(i, *g);
      return g->round() ? !of_own || l == g->cone.axial : i != l;
    case Event::other_w:
      s_.w[i] = 0;
      if (s_.is_axial(i)) s_.tie_against_w(*g);
      if (!s_.enter(i, tolerances::least_remainder)) s_.excused[size_t(i)] = 1;
      return true;
    case Event::inward:
      s_.w[i] = 0;
      s_.role[size_t(i)] = Role::clamped;
      if (g->round()) s_.role[size_t(g->cone.lateral[1])] = Role::resting;
      return true;
    case Event::none:
      break;
  }
  return false;
}

/// True if a set has come back twice while nothing moved.
bool PivotDriver::repeats(int l, double step) {
  if (step > 0) {
    seen_.clear();
    return false;
  }
  const uint64_t now = s_.signature() + uint64_t(l) * 0xd6e8feb86659fd93ULL;
  if (std::find(seen_.begin(), seen_.end(), now) == seen_.end()) {
    seen_.push_back(now);
    return false;
  }
  seen_.clear();
  return std::exchange(least_index_, true);
}

/// Without groups A d = 0 is a proof. A d != 0 with d A d <= 0 is impossible for a semi-definite
/// matrix, unless rounding has perturbed it, in which case A d is small.
LcpStatus PivotDriver::finish_unblocked(int l, bool flat) {
  if (flat && std::fabs(s_.w[l]) <= tolerances::rounded_w * s_.magnitude) {
    s_.excused[size_t(l)] = 1;
    return LcpStatus::solved;
  }
  ray = s_.in_own_units(dz_);
  if (!s_.groups.empty()) return LcpStatus::ray;
  if (flat) return LcpStatus::infeasible;
  return change() > tolerances::rounded_change ? LcpStatus::not_semidefinite : LcpStatus::numeric;
}

LcpStatus PivotDriver::drive(int l) {
  const double sign = s_.w[l] < 0 ? 1 : -1;
  for (;;) {
    charge_work(size_t(s_.n), 2 * size_t(s_.n) + 40);
    if (++s_.pivots > limit_ || stop_requested()) return LcpStatus::max_iterations;
    if (!s_.direction(l, sign, dz_, dw_)) return LcpStatus::numeric;
    const bool flat = s_.remainder() <= tolerances::no_remainder && change() <= tolerances::steady;
    if (!flat && s_.groups.empty() && s_.remainder() < tolerances::indefinite)
      return LcpStatus::not_semidefinite;
    collect(l, sign, flat);
    const Stop stop = pick();
    if (stop.event == Event::none) return finish_unblocked(l, flat);
    add_scaled(s_.z.data(), stop.step(), dz_.data(), s_.n);
    if (!flat) {
      add_scaled(s_.w.data(), stop.step(), dw_.data(), s_.n);
      for (const int i : s_.members()) s_.w[i] = 0;
    }
    const bool goes_on = apply(stop, l);
    if (trace_) note(l, stop);
    if (!goes_on) return LcpStatus::solved;
    if (repeats(l, stop.step())) return LcpStatus::cycling;
  }
}

/// Records the state after a stop, in the problem's units and axes.
void PivotDriver::note(int driven, const Stop& stop) const {
  if (trace_->steps.size() >= trace_->most) {
    ++trace_->left_out;
    return;
  }
  PivotStep& step = trace_->steps.emplace_back();
  step.driven = driven;
  step.event = stop.event;
  step.limiting = stop.index;
  if (driven >= 0) step.step = stop.step() * dz_[driven] * s_.problem.d[size_t(driven)];
  step.z = s_.in_own_units(s_.z);
  for (int i = 0; i < s_.n; ++i) {
    // The driven unknown has left its bound, but has not arrived.
    const bool under_way = i == driven && s_.z[i] != s_.problem.lower[i] &&
                           s_.z[i] != s_.problem.upper[i] && !s_.is_clamped(i);
    const PivotSet set = set_of(s_.role[size_t(i)], s_.place[size_t(i)]);
    step.sets.push_back(under_way && set != PivotSet::tied ? PivotSet::resting : set);
  }
}

/// Drives an open group's axial unknown: first with the laterals as they would slip, then without
/// them.
LcpStatus PivotDriver::push_axial(int l) {
  PivotState::Group& g = s_.group(l);
  s_.tie_against_w(g);
  s_.role[size_t(l)] = Role::resting;
  const LcpStatus end = drive(l);
  if (end == LcpStatus::solved && s_.role[size_t(l)] == Role::resting && s_.z[l] <= 0) {
    s_.open(g);  // excused: its w cannot be improved
    s_.excused[size_t(l)] = 1;
  }
  if (end != LcpStatus::ray || g.prescribed()) return end;
  for (const int t : g.cone.lateral) s_.role[size_t(t)] = Role::resting;
  return drive(l);
}

LcpStatus PivotDriver::correct(int l) {
  seen_.clear();
  if (s_.is_axial(l) && s_.role[size_t(l)] == Role::at_bound) return push_axial(l);
  if (!s_.is_lateral(l)) return drive(l);
  PivotState::Group& g = s_.group(l);
  const int i = g.cone.lateral[0], j = g.cone.lateral[1];
  if (s_.role[size_t(l)] == Role::tied) {
    s_.role[size_t(l)] = Role::resting;
    if (g.round()) s_.role[size_t(j)] = Role::resting;
  }
  if (!g.round() || s_.is_clamped(i) || s_.is_clamped(j)) return drive(l);
  s_.turn(g, s_.w[i], s_.w[j]);
  s_.excused[size_t(i)] = s_.excused[size_t(j)] = 0;
  return drive(i);
}

/// Whether all conditions still hold after the clamped unknowns are refined. Excused unknowns are
/// checked again.
bool PivotDriver::holds() {
  s_.refine();
  restore_bounds(s_);
  bool out = true;
  for (int i = 0; i < s_.n; ++i) {
    if (std::exchange(s_.excused[size_t(i)], char(0))) {
      if (s_.wrong(i) > tolerances::rounded_w * s_.magnitude)
        out = false;
      else
        s_.excused[size_t(i)] = 1;
    }
    if (s_.wrong(i) > s_.tolerance()) out = false;
  }
  return out;
}

LcpStatus PivotDriver::run() {
  if (trace_) note(-1, {});
  for (int round = 1;; ++round) {
    for (int l = choose(); l >= 0; l = choose()) {
      const LcpStatus status = correct(l);
      if (status != LcpStatus::solved) return status;
    }
    if (!s_.groups.empty() || round == tolerances::most_driver_rounds || holds())
      return LcpStatus::solved;
  }
}

}  // namespace tumble::lcp
