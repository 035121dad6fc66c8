#include "engine/math/lcp/pivoting/cone_driver.hpp"

#include "engine/core/stop.hpp"

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

}  // namespace

bool ConeDriver::changes_nothing(int l) const {
  double length = 1, most = 0;
  for (int i = 0; i < s_.n; ++i) {
    length += std::fabs(dz_[i]);
    if (s_.role[size_t(i)] != Role::clamped) most = std::max(most, std::fabs(dw_[i]));
  }
  return std::fabs(dw_[l]) < 1e-9 && most <= 1e-12 * length;
}

void ConeDriver::offer(Event event, int index, double room, double rate) {
  stops_.push_back({event, index, std::max(room, 0.0) / rate, rate});
}

void ConeDriver::collect_surfaces(const ConePivots::Group& g) {
  const int a = g.cone.axial, i = g.cone.lateral[0], j = g.cone.lateral[1];
  if (dz_[a] < -1e-14) offer(Event::apex, a, s_.z[a], -dz_[a]);
  if (g.prescribed()) return;
  if (g.round()) {
    if (s_.role[size_t(i)] == Role::tied) return;
    const double t =
        surface_time(g.cone.slope, s_.z[a], dz_[a], {s_.z[i], s_.z[j]}, {dz_[i], dz_[j]});
    if (t < endless) stops_.push_back({Event::surface, i, t, 1});
    return;
  }
  for (const int k : g.cone.lateral) {
    if (s_.role[size_t(k)] == Role::tied) continue;
    for (const double side : {1.0, -1.0}) {
      const double rate = side * dz_[k] - g.cone.slope * dz_[a];
      if (rate > 1e-14) offer(Event::surface, k, g.cone.slope * s_.z[a] - side * s_.z[k], rate);
    }
  }
}

void ConeDriver::collect_slacks(int l) {
  const double tolerance = s_.tolerance();
  for (int i = 0; i < s_.n; ++i) {
    const auto k = size_t(i);
    if (i == l || s_.excused[k] || s_.wrong(i) > tolerance) continue;
    switch (s_.role[k]) {
      case Role::clamped:
        break;
      case Role::resting:
        if (std::fabs(dw_[i]) > 1e-11) offer(Event::other_w, i, 0, std::fabs(dw_[i]));
        break;
      case Role::at_bound: {
        if (s_.is_lateral(i) || s_.lower[i] == s_.upper[i]) break;
        const double rate = s_.place[k] == Place::upper ? dw_[i] : -dw_[i];
        if (rate > 1e-13) offer(Event::other_w, i, std::fabs(s_.w[i]), rate);
        break;
      }
      case Role::tied: {
        const auto& g = s_.groups[size_t(s_.group_of[k])];
        const size_t axis = g.cone.lateral[0] == i ? 0 : 1;
        if (g.prescribed() || (g.round() && axis == 1)) break;
        const double rate = g.tie[axis] > 0 ? dw_[i] : -dw_[i];
        if (rate > 1e-13) offer(Event::inward, i, -s_.outward(i), rate);
        break;
      }
    }
  }
}

void ConeDriver::collect(int l, double sign, bool flat) {
  stops_.clear();
  if (!flat && sign * dw_[l] > 0) offer(Event::own_w, l, std::fabs(s_.w[l]), std::fabs(dw_[l]));
  for (int i = 0; i < s_.n; ++i) {
    if (s_.group_of[size_t(i)] >= 0 || (i != l && s_.role[size_t(i)] != Role::clamped)) continue;
    if (std::fabs(dz_[i]) <= 1e-14) continue;
    const double room = dz_[i] > 0 ? s_.upper[i] - s_.z[i] : s_.z[i] - s_.lower[i];
    if (room < endless) offer(i == l ? Event::own_bound : Event::bound, i, room, std::fabs(dz_[i]));
  }
  for (const auto& g : s_.groups)
    if (!g.open(s_) || g.cone.axial == l) collect_surfaces(g);
  if (!flat) collect_slacks(l);
}

ConeDriver::Stop ConeDriver::pick() const {
  const double slack = s_.tolerance();
  double reach = endless;
  for (const Stop& c : stops_) reach = std::min(reach, c.step + slack / c.rate);
  Stop best;
  double merit = -1;
  for (const Stop& c : stops_) {
    if (c.step > reach) continue;
    const double own = c.event == Event::own_w ? endless : c.rate;
    if (own > merit) {
      merit = own;
      best = c;
    }
  }
  return best;
}

/// Changes roles; false when the motion of l is over.
bool ConeDriver::apply(const Stop& stop, int l) {
  const int i = stop.index;
  const auto k = size_t(i);
  const int own_group = s_.group_of[size_t(l)];
  auto* g = s_.group_of[k] >= 0 ? &s_.groups[size_t(s_.group_of[k])] : nullptr;
  const bool of_own = g && s_.group_of[k] == own_group;
  switch (stop.event) {
    case Event::own_w:
      s_.w[l] = 0;
      s_.role[size_t(l)] = Role::clamped;
      return false;
    case Event::own_bound:
    case Event::bound: {
      const Place to = dz_[i] > 0 ? Place::upper : Place::lower;
      s_.role[k] = Role::at_bound;
      s_.place[k] = to;
      s_.z[i] = to == Place::upper ? s_.upper[i] : s_.lower[i];
      return stop.event == Event::bound;
    }
    case Event::apex:
      s_.open(*g);
      return !of_own;
    case Event::surface:
      // From the apex the way out is that of the motion.
      if (g->round()) {
        const int j = g->cone.lateral[1];
        const double out = std::fabs(s_.z[i]) + std::fabs(s_.z[j]);
        if (out <= s_.tolerance()) s_.turn(*g, dz_[i], dz_[j]);
        s_.tie_along_z(*g);
        return !of_own || l == g->cone.axial;
      }
      g->tie[g->cone.lateral[0] == i ? 0 : 1] =
          (std::fabs(s_.z[i]) > s_.tolerance() ? s_.z[i] : dz_[i]) > 0 ? g->cone.slope
                                                                       : -g->cone.slope;
      s_.role[k] = Role::tied;
      return i != l;
    case Event::other_w:
      s_.w[i] = 0;
      if (s_.is_axial(i)) s_.tie_against_w(*g);
      s_.role[k] = Role::clamped;
      return true;
    case Event::inward:
      s_.w[i] = 0;
      s_.role[k] = Role::clamped;
      if (g->round()) s_.role[size_t(g->cone.lateral[1])] = Role::resting;
      return true;
    case Event::none:
      break;
  }
  return false;
}

bool ConeDriver::repeats(int l, double step) {
  if (step > 0) {
    seen_.clear();
    return false;
  }
  const uint64_t now = s_.signature() + uint64_t(l) * 0xd6e8feb86659fd93ULL;
  if (std::find(seen_.begin(), seen_.end(), now) != seen_.end()) return true;
  seen_.push_back(now);
  return false;
}

ConeDriver::End ConeDriver::drive(int l) {
  const double sign = s_.w[l] < 0 ? 1 : -1;
  const auto fail = [this](LcpStatus status) {
    failure_ = status;
    return End::failed;
  };
  for (;;) {
    if (++pivots > limit_ || stop_requested()) return fail(LcpStatus::max_iterations);
    if (!s_.direction(l, sign, dz_, dw_)) return fail(LcpStatus::numeric);
    const bool flat = changes_nothing(l);
    collect(l, sign, flat);
    const Stop stop = pick();
    if (stop.event == Event::none) {
      if (flat && std::fabs(s_.w[l]) <= 1e-10 * s_.magnitude) {
        s_.excused[size_t(l)] = 1;
        return End::done;
      }
      return End::open_ended;
    }
    s_.z += stop.step * dz_;
    if (!flat) s_.w += stop.step * dw_;
    if (!apply(stop, l)) return End::done;
    if (repeats(l, stop.step)) return fail(LcpStatus::cycling);
  }
}

/// An open group's axial unknown: first with the laterals as they would slip, then without them.
ConeDriver::End ConeDriver::push_axial(int l) {
  auto& g = s_.groups[size_t(s_.group_of[size_t(l)])];
  s_.tie_against_w(g);
  s_.role[size_t(l)] = Role::resting;
  const End end = drive(l);
  if (end == End::done && s_.role[size_t(l)] == Role::resting && s_.z[l] <= 0) {
    s_.open(g);  // excused: its w cannot be bettered
    s_.excused[size_t(l)] = 1;
  }
  if (end != End::open_ended || g.prescribed()) return end;
  ray = s_.answer(true, dz_);
  for (const int t : g.cone.lateral) s_.role[size_t(t)] = Role::resting;
  return drive(l);
}

ConeDriver::End ConeDriver::correct(int l) {
  seen_.clear();
  if (s_.is_axial(l) && s_.role[size_t(l)] == Role::at_bound) return push_axial(l);
  if (s_.is_axial(l) || !s_.is_lateral(l)) return drive(l);
  auto& g = s_.groups[size_t(s_.group_of[size_t(l)])];
  int driven = l;
  if (s_.role[size_t(l)] == Role::tied) {
    s_.role[size_t(l)] = Role::resting;
    if (g.round()) s_.role[size_t(g.cone.lateral[1])] = Role::resting;
  }
  if (g.round()) {
    const int i = g.cone.lateral[0], j = g.cone.lateral[1];
    if (s_.role[size_t(i)] != Role::clamped && s_.role[size_t(j)] != Role::clamped) {
      s_.turn(g, s_.w[i], s_.w[j]);
      s_.excused[size_t(i)] = s_.excused[size_t(j)] = 0;
      driven = i;
    }
  }
  return drive(driven);
}

LcpStatus ConeDriver::run() {
  for (;;) {
    int worst = -1;
    double most = s_.tolerance();
    for (int i = 0; i < s_.n; ++i) {
      const double x = s_.wrong(i);
      if (x > most) {
        most = x;
        worst = i;
      }
    }
    if (worst < 0) return LcpStatus::solved;
    switch (correct(worst)) {
      case End::done:
        break;
      case End::open_ended:
        ray = s_.answer(true, dz_);
        return LcpStatus::ray;
      case End::failed:
        return failure_;
    }
  }
}

}  // namespace tumble::lcp
