// Sweeps over contacts of two grains, a bundle at a time.
#include "engine/dynamics/grains/pair_kernels.hpp"

#include "engine/dynamics/grains/tolerances.hpp"

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
      : a(in.movers, c.a.data() + lane), b(in.movers, c.b.data() + lane) {}
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

/// Places of the contacts of some lanes. The normal is a unit vector in single precision only:
/// impulses act along it and velocities are measured along it, and the sweeps correct its error.
struct GrainContactPlace {
  GrainV way, n;
  GrainF share, gap;

  static HWY_INLINE GrainContactPlace stored(const GrainBundle& c, size_t lane) {
    const GrainV way = load_grain(c.way, lane);
    return {way, rough_direction(way), load_grain(c.share, lane), load_grain(c.gap, lane)};
  }
  static HWY_INLINE GrainContactPlace present(const GrainPairView& in, GrainBundle& c,
                                              size_t lane) {
    const GrainSpot a(in.points, c.a.data() + lane), b(in.points, c.b.data() + lane);
    const GrainV way = b.x - a.x;
    const GrainF distance = hn::Sqrt(dot(way, way)), half = every_grain(0.5);
    const GrainF gap = distance - (a.radius + b.radius);
    // share = (r_a + gap / 2) / distance.
    const GrainF share = half + half * (a.radius - b.radius) * rough_inverse(distance);
    store_grain(way, c.way, lane);
    store_grain(share, c.share, lane);
    store_grain(gap, c.gap, lane);
    // The stored, rounded values are used here too.
    return {way, rough_direction(way), load_grain(c.share, lane), load_grain(c.gap, lane)};
  }

 private:
  static HWY_INLINE GrainV rough_direction(const GrainV& way) {
    const GrainF square = dot(way, way);
    const GrainV n = rough_inverse_root(square) * way;
    return {n.x, hn::IfThenElse(hn::Gt(square, every_grain(0)), n.y, every_grain(1)), n.z};
  }
};

/// Sums of work by lanes, as GrainWork.
struct GrainWorkLanes {
  GrainF lost, rubbed;
};

HWY_INLINE void add_grain_work(GrainWork& work, size_t lane, const GrainWorkLanes& more) {
  hn::Store(hn::Load(GrainD(), work.lost.data() + lane) + more.lost, GrainD(),
            work.lost.data() + lane);
  hn::Store(hn::Load(GrainD(), work.rubbed.data() + lane) + more.rubbed, GrainD(),
            work.rubbed.data() + lane);
}

/// 1 / x, or 0 where x is 0.
HWY_INLINE GrainF inverse_or_zero(GrainF x) {
  const auto positive = hn::Gt(x, every_grain(0));
  return hn::IfThenElseZero(positive, every_grain(1) / hn::IfThenElse(positive, x, every_grain(1)));
}

/// x, shortened to the length `most` if it is longer.
HWY_INLINE GrainV shortened(const GrainV& x, GrainF most) {
  const GrainF size2 = dot(x, x);
  const auto longer = hn::Gt(size2, most * most);
  if (hn::AllFalse(GrainD(), longer)) return x;
  return hn::IfThenElse(longer, most * rough_inverse_root(size2), every_grain(1)) * x;
}

/// Solid balls have the moment of inertia 2/5 m r^2, so that the inverse mass for slip at their
/// surfaces is 7/2 of the sum of inverse masses.
HWY_INLINE GrainF slip_inverse(GrainF masses) {
  return every_grain(3.5) * masses;
}

void FollowPairs(const GrainPairView& in, GrainRange range) {
  for (uint32_t k = range.begin; k < range.end; ++k)
    for (size_t lane = 0; lane < grain_lanes; lane += grain_step)
      GrainContactPlace::present(in, in.bundles[k], lane);
}

void WarmStartPairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  for (uint32_t k = range.begin; k < range.end; ++k) {
    GrainBundle& c = in.bundles[k];
    for (size_t lane = 0; lane < c.lanes; lane += grain_step) {
      GrainSides sides(in, c, lane);
      const auto place = GrainContactPlace::stored(c, lane);
      const GrainV& n = place.n;
      const GrainF half = every_grain(0.5), masses = sides.a.mass + sides.b.mass;
      const GrainF push = load_grain(c.push, lane);
      GrainV rub = load_grain(c.rub, lane);
      rub = rub - dot(n, rub) * n;
      store_grain(rub, c.rub, lane);
      const GrainV u = sides.slip(place.way, place.share);
      GrainWorkLanes done;
      done.lost = push * (dot(n, u) + half * push * masses);
      done.rubbed = dot(rub, u) + half * dot(rub, rub) * slip_inverse(masses);
      if (in.turnings) {
        const GrainV turn = load_grain(in.turnings[k].turn, lane);
        const GrainV w = sides.b.spin - sides.a.spin;
        done.rubbed =
            done.rubbed + dot(turn, w) + half * dot(turn, turn) * (sides.a.moment + sides.b.moment);
        sides.push(push * n + rub, place.way, place.share);
        sides.turn(turn);
      } else {
        sides.push(push * n + rub, place.way, place.share);
      }
      add_grain_work(work, lane, done);
      sides.write(c, lane);
      if (c.bounces) {
        GrainFloats& most = in.bounces[k].most;
        store_grain(hn::Max(load_grain(most, lane), push), most, lane);
      }
    }
  }
}

/// Rolling and torsional friction; returns its work.
HWY_INLINE GrainF resist_turning(GrainSides& sides, const GrainV& n, GrainF push, GrainTurning& t,
                                 size_t lane) {
  const GrainF zero = every_grain(0), moments = sides.a.moment + sides.b.moment;
  const GrainV before = load_grain(t.turn, lane), w = sides.b.spin - sides.a.spin;
  const GrainV wanted = before - rough_inverse(moments) * w;
  const GrainF along = dot(n, wanted), most = load_grain(t.twisting, lane) * push;
  const GrainF about = hn::Min(hn::Max(along, zero - most), most);
  const GrainV rolling = shortened(wanted - along * n, load_grain(t.rolling, lane) * push);
  const GrainV next = about * n + rolling, change = next - before;
  store_grain(next, t.turn, lane);
  sides.turn(change);
  return dot(change, w) + every_grain(0.5) * dot(change, change) * moments;
}

HWY_INLINE void sweep_lanes(const GrainPairView& in, uint32_t k, size_t lane, double inverse_hs,
                            bool follows, GrainWork& work) {
  GrainBundle& c = in.bundles[k];
  const auto place =
      follows ? GrainContactPlace::present(in, c, lane) : GrainContactPlace::stored(c, lane);
  const GrainV& n = place.n;
  GrainSides sides(in, c, lane);
  const GrainF zero = every_grain(0), half = every_grain(0.5);
  const GrainF masses = sides.a.mass + sides.b.mass, mass = rough_inverse(masses);
  const GrainF push = load_grain(c.push, lane);
  GrainWorkLanes done{zero, zero};
  if (in.turnings) done.rubbed = resist_turning(sides, n, push, in.turnings[k], lane);
  // Friction.
  const GrainV u = sides.slip(place.way, place.share);
  const GrainF un = dot(n, u);
  const GrainV across = u - un * n, rub = load_grain(c.rub, lane);
  const GrainF slip_mass = every_grain(2.0 / 7) * mass;
  GrainV next = rub - slip_mass * across;
  next = shortened(next - dot(n, next) * n, load_grain(c.friction, lane) * push);
  store_grain(next, c.rub, lane);
  const GrainV change = next - rub;
  done.rubbed =
      done.rubbed + dot(change, across) + half * dot(change, change) * slip_inverse(masses);
  // Normals: the gap may at most close. Friction has no effect along them except by rounding.
  const GrainF un_now = un + dot(n, change) * masses;
  const GrainF speed = zero - hn::Max(place.gap, zero) * every_grain(inverse_hs);
  const GrainF pressed = hn::Max(zero, push - mass * (un_now - speed));
  const GrainF more = pressed - push;
  store_grain(pressed, c.push, lane);
  done.lost = more * (un_now + half * more * masses);
  sides.push(change + more * n, place.way, place.share);
  sides.write(c, lane);
  add_grain_work(work, lane, done);
  if (!c.bounces) return;
  GrainFloats& most = in.bounces[k].most;
  store_grain(hn::Max(load_grain(most, lane), pressed), most, lane);
}

void SweepPairs(const GrainPairView& in, GrainRange range, double inverse_hs, bool follows,
                GrainWork& work) {
  for (uint32_t k = range.begin; k < range.end; ++k)
    for (size_t lane = 0; lane < in.bundles[k].lanes; lane += grain_step)
      sweep_lanes(in, k, lane, inverse_hs, follows, work);
}

void PartOverlappingPairs(const GrainPairView& in, GrainRange range) {
  for (uint32_t k = range.begin; k < range.end; ++k) {
    const GrainBundle& c = in.bundles[k];
    for (size_t lane = 0; lane < c.lanes; lane += grain_step) {
      GrainSpot a(in.points, c.a.data() + lane), b(in.points, c.b.data() + lane);
      const GrainF slop = every_grain(tolerances::grain_slop) * hn::Min(a.radius, b.radius);
      const GrainF reach = a.radius + b.radius - slop;
      const GrainV way = b.x - a.x;
      const GrainF d2 = dot(way, way);
      const auto used = hn::FirstN(GrainD(), c.lanes - lane);
      const auto deep = hn::And(hn::Lt(d2, reach * reach), used);
      if (hn::AllFalse(GrainD(), deep)) continue;
      const GrainF mass_a = inverse_masses(in.movers, c.a.data() + lane);
      const GrainF mass_b = inverse_masses(in.movers, c.b.data() + lane);
      // Grains in the same place are moved apart along y.
      const auto apart = hn::Gt(d2, every_grain(0));
      const GrainF d = hn::Sqrt(hn::IfThenElse(apart, d2, every_grain(1)));
      const GrainF depth = reach - hn::IfThenElseZero(apart, d);
      const GrainF part =
          hn::IfThenElseZero(deep, every_grain(tolerances::grain_push_out) *
                                       inverse_or_zero(mass_a + mass_b) * depth / d);
      const GrainV along = {way.x, hn::IfThenElse(apart, way.y, every_grain(1)), way.z};
      a.x = a.x - (part * mass_a) * along;
      b.x = b.x + (part * mass_b) * along;
      a.write(uint32_t(c.writes_a) >> lane);
      b.write(uint32_t(c.writes_b) >> lane);
    }
  }
}

/// The unit vector along `way`.
HWY_INLINE GrainV direction(const GrainV& way) {
  const GrainF distance = hn::Sqrt(dot(way, way)), one = every_grain(1);
  const auto apart = hn::Gt(distance, every_grain(0));
  const GrainV n = (one / hn::IfThenElse(apart, distance, one)) * way;
  return {n.x, hn::IfThenElse(apart, n.y, one), n.z};
}

void BouncePairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  if (!in.bounces) return;
  const GrainF zero = every_grain(0);
  for (uint32_t k = range.begin; k < range.end; ++k) {
    GrainBundle& c = in.bundles[k];
    if (!c.bounces) continue;
    for (size_t lane = 0; lane < c.lanes; lane += grain_step) {
      GrainSides sides(in, c, lane);
      const auto place = GrainContactPlace::stored(c, lane);
      const GrainV n = direction(place.way);
      const GrainF wanted = hn::Load(GrainD(), in.bounces[k].speed.data() + lane);
      const GrainF masses = sides.a.mass + sides.b.mass;
      const auto acts =
          hn::And(hn::Gt(wanted, zero), hn::Gt(load_grain(in.bounces[k].most, lane), zero));
      const GrainF push = load_grain(c.push, lane);
      const GrainF u = dot(n, sides.slip(place.way, place.share));
      const GrainF next = hn::Max(zero, push - inverse_or_zero(masses) * (u - wanted));
      const GrainF more = hn::IfThenElseZero(acts, next - push);
      store_grain(push + more, c.push, lane);
      sides.push(more * n, place.way, place.share);
      sides.write(c, lane);
      add_grain_work(work, lane, {more * (u + every_grain(0.5) * more * masses), zero});
    }
  }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(FollowPairs);
HWY_EXPORT(WarmStartPairs);
HWY_EXPORT(SweepPairs);
HWY_EXPORT(PartOverlappingPairs);
HWY_EXPORT(BouncePairs);

void follow_pairs(const GrainPairView& in, GrainRange range) {
  HWY_DYNAMIC_DISPATCH(FollowPairs)(in, range);
}
void warm_start_pairs(const GrainPairView& in, GrainRange range, GrainWork& work) {
  HWY_DYNAMIC_DISPATCH(WarmStartPairs)(in, range, work);
}
void sweep_pairs(const GrainPairView& in, GrainRange range, double inverse_hs, bool follows,
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
