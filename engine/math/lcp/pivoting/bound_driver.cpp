#include "engine/math/lcp/pivoting/bound_driver.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/kernels.hpp"
#include "engine/math/lcp/pivoting/block_start.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

}  // namespace

int BoundDriver::choose() const {
  int best = -1;
  double most = s_.tolerance();
  for (int i = 0; i < p_.n; ++i) {
    const double x = s_.wrong(i);
    if (x > most) {
      most = least_index_ && best >= 0 ? most : x;
      best = least_index_ && best >= 0 ? best : i;
    }
  }
  return best;
}

void BoundDriver::find_direction(int l, double sign) {
  remainder_ = s_.reduce(l, y_);
  const int m = s_.factor.size();
  for (int k = 0; k < m; ++k) dz_[size_t(k)] = -sign * (y_[size_t(k)] / s_.factor.pivot(k));
  s_.factor.backward(dz_.data());
  for (int i = 0; i < p_.n; ++i) dw_[size_t(i)] = sign * p_.column(l)[i];
  add_columns(dw_.data(), p_.A.data(), p_.n, s_.factor.members().data(), dz_.data(), m, p_.n);
}

/// A d = 0 up to rounding.
bool BoundDriver::changes_nothing(int l) const {
  if (remainder_ > 1e-9) return false;
  double length = 1, most = std::fabs(dw_[size_t(l)]);
  for (int k = 0; k < s_.factor.size(); ++k) length += std::fabs(dz_[size_t(k)]);
  for (int i = 0; i < p_.n; ++i)
    if (!s_.clamped[size_t(i)]) most = std::max(most, std::fabs(dw_[size_t(i)]));
  return most <= 1e-13 * length;
}

void BoundDriver::offer(Stop::Kind kind, int index, double room, double rate) {
  candidates_.push_back({kind, index, std::max(room, 0.0), rate});
}

/// The first stop. Of those that rounding cannot tell apart the one with the greatest rate, which
/// makes the safest pivot (Harris 1973); or, against cycling, the one with the least index.
BoundDriver::Stop BoundDriver::pick() const {
  const double slack = s_.tolerance();
  double reach = never;
  for (const Candidate& c : candidates_) reach = std::min(reach, (c.room + slack) / c.rate);
  Stop out;
  double best = -1;
  for (const Candidate& c : candidates_) {
    if (c.room / c.rate > reach) continue;
    const int index =
        c.kind == Stop::clamped_bound ? s_.factor.members()[size_t(c.index)] : c.index;
    const bool own = c.kind == Stop::driven_w || c.kind == Stop::driven_bound;
    const double merit = own ? never : least_index_ ? 1.0 / (1 + index) : c.rate;
    if (merit > best) {
      best = merit;
      out = {c.kind, c.room / c.rate, c.index};
    }
  }
  return out;
}

BoundDriver::Stop BoundDriver::find_stop(int l, double sign, bool flat) {
  candidates_.clear();
  const double still = 1e-14;
  if (!flat && sign * dw_[size_t(l)] > 0)
    offer(Stop::driven_w, l, std::fabs(s_.w[l]), std::fabs(dw_[size_t(l)]));
  const double own = sign > 0 ? p_.upper[l] - s_.z[l] : s_.z[l] - p_.lower[l];
  if (own < never) offer(Stop::driven_bound, l, own, 1);
  const auto& members = s_.factor.members();
  for (int k = 0; k < int(members.size()); ++k) {
    const int i = members[size_t(k)];
    const double rate = dz_[size_t(k)];
    if (std::fabs(rate) <= still) continue;
    const double room = rate > 0 ? p_.upper[i] - s_.z[i] : s_.z[i] - p_.lower[i];
    if (room < never) offer(Stop::clamped_bound, k, room, std::fabs(rate));
  }
  if (flat) return pick();
  for (int i = 0; i < p_.n; ++i) {
    const auto k = size_t(i);
    const double rate = dw_[k];
    if (i == l || s_.clamped[k] || s_.excused[k] || s_.is_fixed(i) || s_.wrong(i) > s_.tolerance())
      continue;
    if (s_.place[k] == Place::between) {
      if (std::fabs(rate) > 1e-11) offer(Stop::other_w, i, 0, std::fabs(rate));
    } else if (s_.place[k] == Place::lower ? rate < -still * 10 : rate > still * 10) {
      offer(Stop::other_w, i, std::fabs(s_.w[i]), std::fabs(rate));
    }
  }
  return pick();
}

void BoundDriver::move(int l, double sign, const Stop& stop, bool flat) {
  const auto& members = s_.factor.members();
  for (size_t k = 0; k < members.size(); ++k) s_.z[members[k]] += stop.step * dz_[k];
  s_.z[l] += sign * stop.step;
  if (flat) return;
  add_scaled(s_.w.data(), stop.step, dw_.data(), p_.n);
  for (const int i : members) s_.w[i] = 0;
}

/// True when a set came back twice while nothing moved.
bool BoundDriver::repeats(int l, double step) {
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
  if (least_index_) return true;
  least_index_ = true;
  return false;
}

LcpStatus BoundDriver::finish_unblocked(int l, double sign, VecX& ray) {
  if (std::fabs(s_.w[l]) <= 1e-10 * s_.magnitude) {
    s_.excused[size_t(l)] = 1;
    return LcpStatus::solved;
  }
  ray = VecX::Zero(p_.n);
  for (int k = 0; k < s_.factor.size(); ++k)
    ray[s_.factor.members()[size_t(k)]] =
        dz_[size_t(k)] * p_.d[size_t(s_.factor.members()[size_t(k)])];
  ray[l] = sign * p_.d[size_t(l)];
  return LcpStatus::infeasible;
}

/// A d != 0 while d A d <= 0: no semi-definite matrix does that, but one that rounding spoiled may,
/// if A d is small.
LcpStatus BoundDriver::blame() const {
  double length = 1, most = 0;
  for (int k = 0; k < s_.factor.size(); ++k) length += std::fabs(dz_[size_t(k)]);
  for (int i = 0; i < p_.n; ++i)
    if (!s_.clamped[size_t(i)]) most = std::max(most, std::fabs(dw_[size_t(i)]));
  return most > 1e-4 * length ? LcpStatus::not_semidefinite : LcpStatus::numeric;
}

LcpStatus BoundDriver::drive(int l, VecX& ray) {
  const double sign = s_.w[l] < 0 ? 1 : -1;
  for (;;) {
    if (++s_.pivots > limit_ || stop_requested()) return LcpStatus::max_iterations;
    find_direction(l, sign);
    const bool flat = changes_nothing(l);
    if (!flat && remainder_ < -1e-6) return LcpStatus::not_semidefinite;
    const Stop stop = find_stop(l, sign, flat);
    if (stop.kind == Stop::none) {
      if (!flat) return blame();
      return finish_unblocked(l, sign, ray);
    }
    move(l, sign, stop, flat);
    switch (stop.kind) {
      case Stop::driven_w:
        s_.w[l] = 0;
        if (remainder_ > 0) s_.enter(l, y_, remainder_);
        return LcpStatus::solved;
      case Stop::driven_bound:
        s_.place[size_t(l)] = sign > 0 ? Place::upper : Place::lower;
        s_.z[l] = sign > 0 ? p_.upper[l] : p_.lower[l];
        return LcpStatus::solved;
      case Stop::clamped_bound:
        s_.leave_at(stop.index, dz_[size_t(stop.index)] > 0 ? Place::upper : Place::lower);
        break;
      default:
        s_.w[stop.index] = 0;
        if (!s_.enter(stop.index, 1e-15)) s_.excused[size_t(stop.index)] = 1;
    }
    if (repeats(l, stop.step)) return LcpStatus::cycling;
  }
}

LcpStatus BoundDriver::run(VecX& ray) {
  for (int round = 0;; ++round) {
    for (int l = choose(); l >= 0; l = choose()) {
      seen_.clear();
      const LcpStatus status = drive(l, ray);
      if (status != LcpStatus::solved) return status;
    }
    s_.refine();
    restore_bounds(s_);
    bool again = false;
    for (int i = 0; i < p_.n; ++i) {
      if (s_.excused[size_t(i)]) {
        s_.excused[size_t(i)] = 0;
        if (s_.wrong(i) > 1e-10 * s_.magnitude)
          again = true;
        else
          s_.excused[size_t(i)] = 1;
      }
      if (s_.wrong(i) > s_.tolerance()) again = true;
    }
    if (!again || round == 4) return LcpStatus::solved;
  }
}

}  // namespace tumble::lcp
