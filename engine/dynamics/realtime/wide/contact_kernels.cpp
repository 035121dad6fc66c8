// Sweeps over contacts, a bundle at a time; the same in scalars: solve_rows.cpp.
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/realtime/wide/contact_kernels.cpp"
#include <hwy/foreach_target.h>
#include "engine/dynamics/realtime/wide/lanes-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// The two bodies of some lanes of a bundle.
struct Pair {
  Moving a, b;
  F mass_a, mass_b;
  Sym inertia_a, inertia_b;

  HWY_INLINE Pair(WideRows& rows, const WideContact& c, size_t lane)
      : a(rows.bodies.data(), c.a.data() + lane),
        b(rows.bodies.data(), c.b.data() + lane),
        mass_a(load(c.mass_a, lane)),
        mass_b(load(c.mass_b, lane)),
        inertia_a(load(c.inertia_a, lane)),
        inertia_b(load(c.inertia_b, lane)) {}
  HWY_INLINE V slip(const V& ra, const V& rb) const {
    return b.v - a.v + cross(b.w, rb) - cross(a.w, ra);
  }
  /// Applies an impulse P on B and -P on A.
  HWY_INLINE void push(const V& ra, const V& rb, const V& P) {
    a.v = a.v - mass_a * P;
    a.w = a.w - inertia_a * cross(ra, P);
    b.v = b.v + mass_b * P;
    b.w = b.w + inertia_b * cross(rb, P);
  }
  HWY_INLINE void twist(const V& T) {
    a.w = a.w - inertia_a * T;
    b.w = b.w + inertia_b * T;
  }
  HWY_INLINE void write(const WideContact& c, size_t lane) const {
    a.write(uint32_t(c.writes_a) >> lane);
    b.write(uint32_t(c.writes_b) >> lane);
  }
};

/// Change of the gap since the start of the tick at any point of the contact: base + to_b.rb -
/// to_a.ra.
struct GapChange {
  F base;
  V to_a, to_b;
};

HWY_INLINE GapChange gap_change(const Pair& p, const WideContact& c, size_t lane, const V& n) {
  const Four a = read_quad(p.a.at.data(), 2), b = read_quad(p.b.at.data(), 2);
  const V dx = V{p.b.dx0, p.b.dx1, b.c0} - V{p.a.dx0, p.a.dx1, a.c0};
  const V ua{a.c1, a.c2, a.c3}, ub{b.c1, b.c2, b.c3};
  // n.(R r - r) = (R^-1 n - n).r
  GapChange g{dot(n, dx), turned_by(all(0) - scalar_part(ua), ua, n),
              turned_by(all(0) - scalar_part(ub), ub, n)};
  // The gap of round surfaces does not change as they turn: only the part of the arms inside the
  // rounding turns.
  if (c.rounds)
    g.base = g.base + load(c.rounding_a, lane) * dot(n, g.to_a) +
             load(c.rounding_b, lane) * dot(n, g.to_b);
  return g;
}

HWY_INLINE void solve_friction(WidePoint& p, size_t lane, Pair& pair, const V& t1, const V& t2,
                               F mu, F target1, F target2) {
  const V ra = load(p.ra, lane), rb = load(p.rb, lane);
  const V slip = pair.slip(ra, rb);
  const F s1 = dot(t1, slip) - target1, s2 = dot(t2, slip) - target2;
  const F m11 = load(p.m11, lane), m12 = load(p.m12, lane), m22 = load(p.m22, lane);
  const F old1 = load(p.tangent1, lane), old2 = load(p.tangent2, lane);
  const F limit = mu * load(p.normal, lane);
  F f1 = old1 - (m11 * s1 + m12 * s2), f2 = old2 - (m12 * s1 + m22 * s2);
  const F square = limit * limit;
  const M slides = hn::Gt(f1 * f1 + f2 * f2, square);
  if (!hn::AllFalse(Lanes(), slides)) {
    // A gradient step, whose fixed point opposes the slip in every direction alike.
    const F diff = all(0.5f) * (m11 - m22);
    const F least = all(0.5f) * (m11 + m22) - hn::Sqrt(diff * diff + m12 * m12);
    const F g1 = old1 - least * s1, g2 = old2 - least * s2;
    const F length2 = g1 * g1 + g2 * g2;
    const F scale =
        hn::IfThenElse(hn::Gt(length2, square), hn::Div(limit, hn::Sqrt(length2)), all(1));
    f1 = hn::IfThenElse(slides, g1 * scale, f1);
    f2 = hn::IfThenElse(slides, g2 * scale, f2);
  }
  store(f1, p.tangent1, lane);
  store(f2, p.tangent2, lane);
  pair.push(ra, rb, (f1 - old1) * t1 + (f2 - old2) * t2);
}

/// Rolling and torsional friction, as TurningRow::solve.
HWY_INLINE void solve_turning(WideTurning& r, const WidePoint* points, uint32_t count, size_t lane,
                              Pair& pair, const V& n, const V& t1, const V& t2) {
  F pressure = all(0);
  for (uint32_t k = 0; k < count; ++k) pressure = pressure + load(points[k].normal, lane);
  const V w = pair.b.w - pair.a.w;
  const F w1 = dot(t1, w), w2 = dot(t2, w);
  const F m11 = load(r.m11, lane), m12 = load(r.m12, lane), m22 = load(r.m22, lane);
  const V old = load(r.impulse, lane);
  const F limit = load(r.rolling, lane) * pressure, square = limit * limit;
  F r1 = old.x - (m11 * w1 + m12 * w2), r2 = old.y - (m12 * w1 + m22 * w2);
  const M rolls = hn::Gt(r1 * r1 + r2 * r2, square);
  if (!hn::AllFalse(Lanes(), rolls)) {
    // A gradient step, whose fixed point opposes the turning in every direction alike.
    const F diff = all(0.5f) * (m11 - m22);
    const F least = all(0.5f) * (m11 + m22) - hn::Sqrt(diff * diff + m12 * m12);
    const F g1 = old.x - least * w1, g2 = old.y - least * w2;
    const F length2 = g1 * g1 + g2 * g2;
    const F scale =
        hn::IfThenElse(hn::Gt(length2, square), hn::Div(limit, hn::Sqrt(length2)), all(1));
    r1 = hn::IfThenElse(rolls, g1 * scale, r1);
    r2 = hn::IfThenElse(rolls, g2 * scale, r2);
  }
  const F most = load(r.torsional, lane) * pressure;
  const F spinning =
      dot(n, w) + load(r.k13, lane) * (r1 - old.x) + load(r.k23, lane) * (r2 - old.y);
  const F wanted = old.z - load(r.torsional_mass, lane) * spinning;
  const V next{r1, r2, hn::Max(all(0) - most, hn::Min(wanted, most))};
  store(next, r.impulse, lane);
  const V change = next - old;
  pair.twist(change.x * t1 + change.y * t2 + change.z * n);
}

struct SoftLanes {
  F bias_rate, mass_scale, impulse_scale;
};
HWY_INLINE SoftLanes softness(const WideContact& c, size_t lane, const WideStep& s) {
  const M hard = hn::Gt(load(c.hard, lane), all(0));
  return {hn::IfThenElse(hard, all(s.hard.bias_rate), all(s.soft.bias_rate)),
          hn::IfThenElse(hard, all(s.hard.mass_scale), all(s.soft.mass_scale)),
          hn::IfThenElse(hard, all(s.hard.impulse_scale), all(s.soft.impulse_scale))};
}

template <bool biased>
HWY_INLINE void solve_normal(WidePoint& p, size_t lane, Pair& pair, const V& n,
                             const GapChange& change, const SoftLanes& soft, F rate, F push_out) {
  const V ra = load(p.ra, lane), rb = load(p.rb, lane);
  const F gap = load(p.gap, lane) + change.base + dot(change.to_b, rb) - dot(change.to_a, ra);
  const M apart = hn::Gt(gap, all(0));
  const F old = load(p.normal, lane);
  F bias = hn::IfThenElseZero(apart, gap * rate);
  F mass = load(p.normal_mass, lane);
  F wanted = old;
  if constexpr (biased) {
    bias = hn::IfThenElse(apart, bias, hn::Max(soft.bias_rate * gap, all(0) - push_out));
    mass = hn::IfThenElse(apart, mass, mass * soft.mass_scale);
    wanted = old - hn::IfThenZeroElse(apart, soft.impulse_scale * old);
  }
  const F approach = dot(n, pair.slip(ra, rb));
  const F next = hn::Max(wanted - mass * (approach + bias), all(0));
  store(next, p.normal, lane);
  pair.push(ra, rb, (next - old) * n);
}

template <bool biased>
HWY_INLINE void sweep(WideRows& rows, WideRange range, const WideStep& step) {
  const F rate = all(1 / step.hs), push_out = all(step.push_out_speed);
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideContact& c = rows.contacts[i];
    WidePoint* const points = rows.points.data() + c.first;
    for (size_t lane = 0; lane < c.lanes; lane += step_lanes) {
      Pair pair(rows, c, lane);
      const V n = load(c.n, lane), t1 = load(c.t1, lane), t2 = cross(n, t1);
      const F mu = load(c.friction, lane);
      const F target1 = load(c.target1, lane), target2 = load(c.target2, lane);
      // Friction first, so that normal impulses have the last word on overlap.
      for (uint32_t k = 0; k < c.count; ++k)
        solve_friction(points[k], lane, pair, t1, t2, mu, target1, target2);
      const bool turns = c.turning != WideContact::no_turning;
      if (biased && turns)
        solve_turning(rows.turnings[c.turning], points, c.count, lane, pair, n, t1, t2);
      const GapChange change = gap_change(pair, c, lane, n);
      const SoftLanes soft = softness(c, lane, step);
      for (uint32_t k = 0; k < c.count; ++k)
        solve_normal<biased>(points[k], lane, pair, n, change, soft, rate, push_out);
      // After the normal impulses that bound it, as in solve_rows.
      if (!biased && turns)
        solve_turning(rows.turnings[c.turning], points, c.count, lane, pair, n, t1, t2);
      pair.write(c, lane);
      if constexpr (!biased) {
        for (uint32_t k = 0; k < c.count; ++k) {
          WidePoint& p = points[k];
          store(load(p.normal_sum, lane) + load(p.normal, lane), p.normal_sum, lane);
          store(load(p.tangent1_sum, lane) + load(p.tangent1, lane), p.tangent1_sum, lane);
          store(load(p.tangent2_sum, lane) + load(p.tangent2, lane), p.tangent2_sum, lane);
        }
        if (c.turning != WideContact::no_turning) {
          WideTurning& r = rows.turnings[c.turning];
          store(load(r.sum, lane) + load(r.impulse, lane), r.sum, lane);
        }
      }
    }
  }
}

void Solve(WideRows& rows, WideRange range, const WideStep& step) {
  sweep<true>(rows, range, step);
}
void Relax(WideRows& rows, WideRange range, const WideStep& step) {
  sweep<false>(rows, range, step);
}

void WarmStart(WideRows& rows, WideRange range) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const WideContact& c = rows.contacts[i];
    const WidePoint* const points = rows.points.data() + c.first;
    for (size_t lane = 0; lane < c.lanes; lane += step_lanes) {
      Pair pair(rows, c, lane);
      const V n = load(c.n, lane), t1 = load(c.t1, lane), t2 = cross(n, t1);
      V P{all(0), all(0), all(0)}, on_a = P, on_b = P;
      for (uint32_t k = 0; k < c.count; ++k) {
        const WidePoint& p = points[k];
        const V one =
            load(p.normal, lane) * n + load(p.tangent1, lane) * t1 + load(p.tangent2, lane) * t2;
        P = P + one;
        on_a = on_a + cross(load(p.ra, lane), one);
        on_b = on_b + cross(load(p.rb, lane), one);
      }
      if (c.turning != WideContact::no_turning) {
        const V about = load(rows.turnings[c.turning].impulse, lane);
        const V T = about.x * t1 + about.y * t2 + about.z * n;
        on_a = on_a + T;
        on_b = on_b + T;
      }
      pair.a.v = pair.a.v - pair.mass_a * P;
      pair.a.w = pair.a.w - pair.inertia_a * on_a;
      pair.b.v = pair.b.v + pair.mass_b * P;
      pair.b.w = pair.b.w + pair.inertia_b * on_b;
      pair.write(c, lane);
    }
  }
}

void Bounce(WideRows& rows, WideRange range) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const WideContact& c = rows.contacts[i];
    if (!c.bounces) continue;
    for (size_t lane = 0; lane < c.lanes; lane += step_lanes) {
      Pair pair(rows, c, lane);
      const V n = load(c.n, lane);
      F change = all(0);
      for (uint32_t k = 0; k < c.count; ++k) {
        WidePoint& p = rows.points[c.first + k];
        LaneFloats& rebounds = rows.rebounds[c.first + k];
        const V ra = load(p.ra, lane), rb = load(p.rb, lane);
        const F bounce = load(p.bounce, lane), sum = load(p.normal_sum, lane);
        const F mass = load(p.normal_mass, lane), rebound = load(rebounds, lane);
        const M acts = hn::And(hn::Gt(bounce, all(0)), hn::Gt(sum, all(0)));
        const F wanted = mass * (bounce - dot(n, pair.slip(ra, rb)));
        // Impulses that joints made too large are reduced, but the contact never pulls.
        const F push = hn::IfThenElseZero(acts, hn::Max(wanted, all(0) - rebound));
        // The impulse of restitution counts in the sum, but not in the next warm start.
        store(sum + push, p.normal_sum, lane);
        store(rebound + push, rebounds, lane);
        pair.push(ra, rb, push * n);
        change = hn::Max(change, hn::IfThenElseZero(acts, hn::Div(hn::Abs(push), mass * bounce)));
      }
      store(change, rows.blow_changes[i], lane);
      pair.write(c, lane);
    }
  }
}

float Residual(WideRows& rows, WideRange range) {
  F most = all(0);
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const WideContact& c = rows.contacts[i];
    for (size_t lane = 0; lane < c.lanes; lane += step_lanes) {
      const Pair pair(rows, c, lane);
      const V n = load(c.n, lane);
      for (uint32_t k = 0; k < c.count; ++k) {
        const WidePoint& p = rows.points[c.first + k];
        const M pressed = hn::Gt(load(p.normal, lane), all(0));
        const F approach = all(0) - dot(n, pair.slip(load(p.ra, lane), load(p.rb, lane)));
        most = hn::Max(most, hn::IfThenElseZero(pressed, approach));
      }
    }
  }
  return greatest_lane(most);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(Solve);
HWY_EXPORT(Relax);
HWY_EXPORT(WarmStart);
HWY_EXPORT(Bounce);
HWY_EXPORT(Residual);

void wide_solve(WideRows& rows, WideRange contacts, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(Solve)(rows, contacts, step);
}
void wide_relax(WideRows& rows, WideRange contacts, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(Relax)(rows, contacts, step);
}
void wide_warm_start(WideRows& rows, WideRange contacts) {
  HWY_DYNAMIC_DISPATCH(WarmStart)(rows, contacts);
}
void wide_bounce(WideRows& rows, WideRange contacts) {
  HWY_DYNAMIC_DISPATCH(Bounce)(rows, contacts);
}
float wide_residual(WideRows& rows, WideRange contacts) {
  return HWY_DYNAMIC_DISPATCH(Residual)(rows, contacts);
}

}  // namespace tumble
#endif
