// Sweeps over contacts of two grains, a bundle at a time.
#include "engine/dynamics/grains/pair_kernels.hpp"

#include "engine/core/prefetch.hpp"
#include "engine/dynamics/grains/tolerances.hpp"

#include <algorithm>

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/grains/pair_kernels.cpp"
#include <hwy/foreach_target.h>
#include "engine/dynamics/grains/grain_lanes-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// The two grains of some lanes of a bundle.
struct GrainSides {
  GrainMoving a, b;

  HWY_INLINE GrainSides(const GrainPairView& in, const GrainBundle& c, size_t lane)
      : a(in.rows, c.a.data() + lane), b(in.rows, c.b.data() + lane) {}
  /// Velocity of b's surface relative to a's at the contact.
  HWY_INLINE GrainV slip(const GrainV& way, GrainF share) const {
    return b.v - a.v - cross(a.spin + (every_grain(1) - share) * (b.spin - a.spin), way);
  }
  /// Applies an impulse P on b and -P on a at the contact; conserves momentum and angular momentum
  /// for any P.
  HWY_INLINE void push(const GrainV& P, const GrainV& way, GrainF share) {
    const GrainV moment = cross(way, P);
    a.v = a.v - a.mass * P;
    b.v = b.v + b.mass * P;
    a.spin = a.spin - (a.moment * share) * moment;
    b.spin = b.spin - (b.moment * (every_grain(1) - share)) * moment;
  }
  HWY_INLINE void turn(const GrainV& T) {
    a.spin = a.spin - a.moment * T;
    b.spin = b.spin + b.moment * T;
  }
  HWY_INLINE void write(const GrainBundle& c, size_t lane) const {
    a.write(uint32_t(c.writes_a) >> lane);
    b.write(uint32_t(c.writes_b) >> lane);
  }
};

/// Places of the contacts of some lanes.
struct GrainContactPlace {
  GrainV way, n;
  GrainF gap;

  static HWY_INLINE GrainContactPlace stored(const GrainBundle& c, size_t lane) {
    const GrainV way = load_grain(c.way, lane);
    return {way, direction(way, inverse_or_zero(hn::Sqrt(dot(way, way)))), load_grain(c.gap, lane)};
  }
  /// Of a contact whose grains have moved.
  static HWY_INLINE GrainContactPlace present(const GrainPairView& in, GrainBundle& c,
                                              size_t lane) {
    const GrainShifting a(in.shifts, c.a.data() + lane), b(in.shifts, c.b.data() + lane);
    const auto at = between(a, b, c, lane);
    store_grain(at.way, c.way, lane);
    store_grain(at.gap, c.gap, lane);
    return at;
  }
  static HWY_INLINE GrainContactPlace between(const GrainShifting& a, const GrainShifting& b,
                                              const GrainBundle& c, size_t lane) {
    GrainContactPlace at;
    at.way = load_grain(c.from, lane) + (b.x - a.x);
    const GrainF distance = hn::Sqrt(dot(at.way, at.way));
    at.gap = distance - load_grain(c.reach, lane);
    at.n = direction(at.way, inverse_or_zero(distance));
    return at;
  }

 private:
  /// Grains with the same centre have a direction too, in which they part: that of the y axis, from
  /// the one with the lower key.
  static HWY_INLINE GrainV direction(const GrainV& way, GrainF inverse) {
    const auto apart = hn::Gt(inverse, every_grain(0));
    return {inverse * way.x, hn::IfThenElse(apart, inverse * way.y, every_grain(1)),
            inverse * way.z};
  }
};

/// Sums of work by lanes, of the bundles of one range: few enough for single precision.
struct GrainWorkLanes {
  alignas(64) std::array<float, grain_lanes> lost{}, rubbed{};

  HWY_INLINE void add(size_t lane, GrainF more_lost, GrainF more_rubbed) {
    const GrainD d;
    hn::Store(hn::Load(d, lost.data() + lane) + more_lost, d, lost.data() + lane);
    hn::Store(hn::Load(d, rubbed.data() + lane) + more_rubbed, d, rubbed.data() + lane);
  }
  void add_to(GrainWork& work) const {
    for (size_t lane = 0; lane < grain_lanes; ++lane) {
      work.lost[lane] += double(lost[lane]);
      work.rubbed[lane] += double(rubbed[lane]);
    }
  }
};

/// x, shortened to the length `most` if it is longer.
HWY_INLINE GrainV shortened(const GrainV& x, GrainF most) {
  const GrainF size2 = dot(x, x);
  const auto longer = hn::Gt(size2, most * most);
  if (hn::AllFalse(GrainD(), longer)) return x;
  return hn::IfThenElse(longer, most * inverse_or_zero(hn::Sqrt(size2)), every_grain(1)) * x;
}

/// Solid balls have the moment of inertia 2/5 m r^2, so that the inverse mass for slip at their
/// surfaces is 7/2 of the sum of inverse masses.
HWY_INLINE GrainF slip_inverse(GrainF masses) {
  return every_grain(3.5f) * masses;
}

void ReadForces(const GrainForcesView& from, float unit, GrainBundle& to) {
  for (size_t lane = 0; lane < grain_lanes; lane += grain_step) {
    std::array<const float*, grain_step> at;
    for (size_t k = 0; k < grain_step; ++k)
      at[k] = reinterpret_cast<const float*>(
          &from.forces[from.source[std::min(lane + k, size_t(to.lanes - 1))]]);
    const auto used = hn::FirstN(GrainD(), lane < to.lanes ? to.lanes - lane : 0);
    const GrainF scale = hn::IfThenElseZero(used, every_grain(unit));
    const GrainFour t0 = read_four(at.data(), 0);
    store_grain(scale * t0.x, to.push, lane);
    store_grain(scale * GrainV{t0.y, t0.z, t0.w}, to.rub, lane);
    if (!from.turning) continue;
    const GrainFour t1 = read_four(at.data(), 4);
    store_grain(scale * GrainV{t1.x, t1.y, t1.z}, from.turning->turn, lane);
  }
}

void WriteForces(const GrainForcesView& to, float unit, const GrainBundle& from) {
  const GrainF scale = every_grain(unit), zero = every_grain(0);
  for (size_t lane = 0; lane < from.lanes; lane += grain_step) {
    std::array<float*, grain_step> at;
    for (size_t k = 0; k < grain_step; ++k)
      at[k] = reinterpret_cast<float*>(
          &to.forces[to.source[std::min(lane + k, size_t(from.lanes - 1))]]);
    const uint32_t mask = ((1u << from.lanes) - 1) >> lane;
    const GrainV rub = scale * load_grain(from.rub, lane);
    write_four({scale * load_grain(from.push, lane), rub.x, rub.y, rub.z}, at.data(), mask, 0);
    const GrainV turn =
        to.turning ? scale * load_grain(to.turning->turn, lane) : GrainV{zero, zero, zero};
    write_four({turn.x, turn.y, turn.z, zero}, at.data(), mask, 4);
  }
}

HWY_INLINE void warm_start_lanes(const GrainPairView& in, uint32_t k, size_t lane,
                                 GrainWorkLanes& work) {
  GrainBundle& c = in.bundles[k];
  GrainSides sides(in, c, lane);
  const auto place = GrainContactPlace::stored(c, lane);
  const GrainF share = load_grain(c.share, lane);
  const GrainV& n = place.n;
  const GrainF half = every_grain(0.5f), masses = sides.a.mass + sides.b.mass;
  const GrainF push = load_grain(c.push, lane);
  GrainV rub = load_grain(c.rub, lane);
  rub = rub - dot(n, rub) * n;
  store_grain(rub, c.rub, lane);
  const GrainV u = sides.slip(place.way, share);
  GrainF rubbed = dot(rub, u) + half * dot(rub, rub) * slip_inverse(masses);
  sides.push(push * n + rub, place.way, share);
  if (in.turnings) {
    const GrainV turn = load_grain(in.turnings[k].turn, lane);
    const GrainV w = sides.b.spin - sides.a.spin;
    rubbed = rubbed + dot(turn, w) + half * dot(turn, turn) * (sides.a.moment + sides.b.moment);
    sides.turn(turn);
  }
  work.add(lane, push * (dot(n, u) + half * push * masses), rubbed);
  sides.write(c, lane);
  if (!c.bounces) return;
  GrainFloats& most = in.bounces[k].most;
  store_grain(hn::Max(load_grain(most, lane), push), most, lane);
}

/// Calls f(k, lane) for the first of every few lanes that are computed at once, of all bundles.
/// A bundle is as long as seventeen cache lines and is left after some hundred instructions, so the
/// next one is fetched meanwhile.
template <class F>
HWY_INLINE void each_lanes(const GrainPairView& in, GrainRange range, const F& f) {
  for (uint32_t k = range.begin; k < range.end; ++k) {
    prefetch<sizeof(GrainBundle)>(&in.bundles[k + 1]);
    for (size_t lane = 0; lane < in.bundles[k].lanes; lane += grain_step) f(k, lane);
  }
}

void WarmStartPairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  GrainWorkLanes sum;
  each_lanes(in, range,
             [&](uint32_t k, size_t lane) HWY_ATTR { warm_start_lanes(in, k, lane, sum); });
  sum.add_to(work);
}

/// Rolling and torsional friction; returns its work.
HWY_INLINE GrainF resist_turning(GrainSides& sides, const GrainV& n, GrainF push, GrainTurning& t,
                                 size_t lane) {
  const GrainF zero = every_grain(0), moments = sides.a.moment + sides.b.moment;
  const GrainV before = load_grain(t.turn, lane), w = sides.b.spin - sides.a.spin;
  const GrainV wanted = before - inverse_or_zero(moments) * w;
  const GrainF along = dot(n, wanted), most = load_grain(t.twisting, lane) * push;
  const GrainF about = hn::Min(hn::Max(along, zero - most), most);
  const GrainV rolling = shortened(wanted - along * n, load_grain(t.rolling, lane) * push);
  const GrainV next = about * n + rolling, change = next - before;
  store_grain(next, t.turn, lane);
  sides.turn(change);
  return dot(change, w) + every_grain(0.5f) * dot(change, change) * moments;
}

HWY_INLINE void sweep_lanes(const GrainPairView& in, uint32_t k, size_t lane, float inverse_hs,
                            bool follows, GrainWorkLanes& work) {
  GrainBundle& c = in.bundles[k];
  GrainSides sides(in, c, lane);
  const GrainF share = load_grain(c.share, lane);
  const auto place =
      follows ? GrainContactPlace::present(in, c, lane) : GrainContactPlace::stored(c, lane);
  const GrainV& n = place.n;
  const GrainF zero = every_grain(0), half = every_grain(0.5f);
  const GrainF masses = sides.a.mass + sides.b.mass, mass = inverse_or_zero(masses);
  const GrainF push = load_grain(c.push, lane);
  GrainF rubbed = zero;
  if (in.turnings) rubbed = resist_turning(sides, n, push, in.turnings[k], lane);
  // Friction.
  const GrainV u = sides.slip(place.way, share);
  const GrainF un = dot(n, u);
  const GrainV across = u - un * n, rub = load_grain(c.rub, lane);
  const GrainF slip_mass = every_grain(2.0f / 7) * mass;
  GrainV next = rub - slip_mass * across;
  next = shortened(next - dot(n, next) * n, load_grain(c.friction, lane) * push);
  store_grain(next, c.rub, lane);
  const GrainV change = next - rub;
  rubbed = rubbed + dot(change, across) + half * dot(change, change) * slip_inverse(masses);
  // Normals: the gap may at most close. Friction has no effect along them except by rounding.
  const GrainF un_now = un + dot(n, change) * masses;
  const GrainF speed = zero - hn::Max(place.gap, zero) * every_grain(inverse_hs);
  const GrainF pressed = hn::Max(zero, push - mass * (un_now - speed));
  const GrainF more = pressed - push;
  store_grain(pressed, c.push, lane);
  sides.push(change + more * n, place.way, share);
  sides.write(c, lane);
  work.add(lane, more * (un_now + half * more * masses), rubbed);
  if (!c.bounces) return;
  GrainFloats& most = in.bounces[k].most;
  store_grain(hn::Max(load_grain(most, lane), pressed), most, lane);
}

template <bool follows>
HWY_INLINE void sweep_range(const GrainPairView& in, GrainRange range, float inverse_hs,
                            GrainWork& work) {
  GrainWorkLanes sum;
  each_lanes(in, range, [&](uint32_t k, size_t lane) HWY_ATTR {
    sweep_lanes(in, k, lane, inverse_hs, follows, sum);
  });
  sum.add_to(work);
}

void SweepPairs(const GrainPairView& in, GrainRange range, float inverse_hs, bool follows,
                GrainWork& work) {
  if (follows)
    sweep_range<true>(in, range, inverse_hs, work);
  else
    sweep_range<false>(in, range, inverse_hs, work);
}

HWY_INLINE void part_lanes(const GrainPairView& in, const GrainBundle& c, size_t lane) {
  GrainShifting a(in.shifts, c.a.data() + lane), b(in.shifts, c.b.data() + lane);
  const auto at = GrainContactPlace::between(a, b, c, lane);
  const GrainF share = load_grain(c.share, lane), zero = every_grain(0);
  const GrainF least = load_grain(c.reach, lane) * hn::Min(share, every_grain(1) - share);
  const GrainF deep = zero - at.gap - every_grain(float(tolerances::grain_slop)) * least;
  if (hn::AllFalse(GrainD(), hn::Gt(deep, zero))) return;
  const GrainF part = every_grain(float(tolerances::grain_push_out)) * hn::Max(deep, zero) *
                      inverse_or_zero(a.mass + b.mass);
  a.x = a.x - (part * a.mass) * at.n;
  b.x = b.x + (part * b.mass) * at.n;
  a.write(uint32_t(c.writes_a) >> lane);
  b.write(uint32_t(c.writes_b) >> lane);
}

void PartOverlappingPairs(const GrainPairView& in, GrainRange range) {
  each_lanes(in, range,
             [&](uint32_t k, size_t lane) HWY_ATTR { part_lanes(in, in.bundles[k], lane); });
}

HWY_INLINE void bounce_lanes(const GrainPairView& in, uint32_t k, size_t lane,
                             GrainWorkLanes& work) {
  GrainBundle& c = in.bundles[k];
  GrainSides sides(in, c, lane);
  const auto place = GrainContactPlace::stored(c, lane);
  const GrainF share = load_grain(c.share, lane), zero = every_grain(0);
  const GrainF wanted = load_grain(in.bounces[k].speed, lane);
  const GrainF masses = sides.a.mass + sides.b.mass;
  const auto acts =
      hn::And(hn::Gt(wanted, zero), hn::Gt(load_grain(in.bounces[k].most, lane), zero));
  const GrainF push = load_grain(c.push, lane);
  const GrainF u = dot(place.n, sides.slip(place.way, share));
  const GrainF next = hn::Max(zero, push - inverse_or_zero(masses) * (u - wanted));
  const GrainF more = hn::IfThenElseZero(acts, next - push);
  store_grain(push + more, c.push, lane);
  sides.push(more * place.n, place.way, share);
  sides.write(c, lane);
  work.add(lane, more * (u + every_grain(0.5f) * more * masses), zero);
}

void BouncePairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  if (!in.bounces) return;
  GrainWorkLanes sum;
  for (uint32_t k = range.begin; k < range.end; ++k)
    for (size_t lane = 0; in.bundles[k].bounces && lane < in.bundles[k].lanes; lane += grain_step)
      bounce_lanes(in, k, lane, sum);
  sum.add_to(work);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(ReadForces);
HWY_EXPORT(WriteForces);
HWY_EXPORT(WarmStartPairs);
HWY_EXPORT(SweepPairs);
HWY_EXPORT(PartOverlappingPairs);
HWY_EXPORT(BouncePairs);

void read_forces(const GrainForcesView& from, float unit, GrainBundle& to) {
  HWY_DYNAMIC_DISPATCH(ReadForces)(from, unit, to);
}
void write_forces(const GrainForcesView& to, float unit, const GrainBundle& from) {
  HWY_DYNAMIC_DISPATCH(WriteForces)(to, unit, from);
}
void warm_start_pairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  HWY_DYNAMIC_DISPATCH(WarmStartPairs)(in, range, work);
}
void sweep_pairs(const GrainPairView& in, GrainRange range, float inverse_hs, bool follows,
                 GrainWork& work) {
  HWY_DYNAMIC_DISPATCH(SweepPairs)(in, range, inverse_hs, follows, work);
}
void part_overlapping_pairs(const GrainPairView& in, GrainRange range) {
  HWY_DYNAMIC_DISPATCH(PartOverlappingPairs)(in, range);
}
void bounce_pairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  HWY_DYNAMIC_DISPATCH(BouncePairs)(in, range, work);
}

}  // namespace tumble
#endif
