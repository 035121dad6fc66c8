// Preparation of contacts and motion of bodies, a bundle at a time; the same in scalars:
// prepare_rows.cpp, integrate_bodies.cpp.
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/realtime/wide/body_kernels.cpp"
#include <hwy/foreach_target.h>
#include "engine/dynamics/realtime/wide/lanes-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// A tangent of the unit vector n; J. Duff et al., "Building an Orthonormal Basis, Revisited"
/// (2017).
HWY_INLINE V tangent(const V& n) {
  const F sign = hn::IfThenElse(hn::Lt(n.z, all(0)), all(-1), all(1));
  const F a = hn::Div(all(-1), sign + n.z);
  return {all(1) + sign * n.x * n.x * a, sign * n.x * n.y * a, all(0) - sign * n.x};
}

/// Mobility u.K v of both bodies together at a point.
struct Mobility {
  F mass;
  const Held& a;
  const Held& b;
  V ra, rb;
  HWY_INLINE F operator()(const V& u, const V& v) const {
    return mass * dot(u, v) + dot(cross(ra, u), a.inertia * cross(ra, v)) +
           dot(cross(rb, u), b.inertia * cross(rb, v));
  }
};

HWY_INLINE void set_masses(WidePoint& p, size_t lane, const Mobility& k, M there, const V& n,
                           const V& t1, const V& t2) {
  store(hn::IfThenElseZero(there, inverse(k(n, n))), p.normal_mass, lane);
  const F k11 = k(t1, t1), k12 = k(t1, t2), k22 = k(t2, t2);
  const F one = hn::IfThenElseZero(there, inverse(k11 * k22 - k12 * k12));
  store(k22 * one, p.m11, lane);
  store(all(0) - k12 * one, p.m12, lane);
  store(k11 * one, p.m22, lane);
}

/// Impulses of the sub-step from the staged forces.
HWY_INLINE void set_impulses(WidePoint& p, size_t lane, F hs, const V& t1, const V& t2) {
  const V force{load(p.tangent1, lane), load(p.tangent2, lane), load(p.tangent1_sum, lane)};
  store(hs * load(p.normal, lane), p.normal, lane);
  store(hs * dot(t1, force), p.tangent1, lane);
  store(hs * dot(t2, force), p.tangent2, lane);
  store(all(0), p.normal_sum, lane);
  store(all(0), p.tangent1_sum, lane);
  store(all(0), p.tangent2_sum, lane);
}

/// As bounce_speed in prepare_rows.cpp. Returns whether any lane bounces.
HWY_INLINE bool set_bounce(WidePoint& p, size_t lane, const V& n, const V& slip, F pull, F e,
                           const WideStep& step) {
  const F approach = all(0) - dot(n, slip);
  const F fall = hn::Max(pull, all(0)) * hn::Max(load(p.gap, lane), all(0));
  const F speed = e * hn::Sqrt(approach * approach + fall + fall);
  const M acts = hn::And(hn::Gt(e, all(0)), hn::Gt(approach, all(step.restitution_threshold)));
  store(hn::IfThenElseZero(acts, speed), p.bounce, lane);
  return !hn::AllFalse(Lanes(), acts);
}

/// As TurningRow::set_masses; and impulses of the sub-step from the staged torques.
HWY_INLINE void prepare_turning(WideTurning& r, size_t lane, F hs, const Held& a, const Held& b,
                                const V& n, const V& t1, const V& t2) {
  const auto k = [&](const V& u, const V& v)
                     HWY_ATTR { return dot(u, a.inertia * v) + dot(u, b.inertia * v); };
  const F k11 = k(t1, t1), k12 = k(t1, t2), k22 = k(t2, t2);
  // Lanes without a contact or without inertia give nothing positive, and get zero mass.
  const F one = inverse(k11 * k22 - k12 * k12);
  store(k22 * one, r.m11, lane);
  store(all(0) - k12 * one, r.m12, lane);
  store(k11 * one, r.m22, lane);
  store(inverse(k(n, n)), r.torsional_mass, lane);
  store(k(t1, n), r.k13, lane);
  store(k(t2, n), r.k23, lane);
  const V torque = load(r.impulse, lane);
  store(V{hs * dot(t1, torque), hs * dot(t2, torque), hs * dot(n, torque)}, r.impulse, lane);
  store(V{all(0), all(0), all(0)}, r.sum, lane);
}

HWY_INLINE void prepare_lanes(WideRows& rows, WideContact& c, size_t lane, const WideStep& step) {
  const Moving a(rows.bodies.data(), c.a.data() + lane), b(rows.bodies.data(), c.b.data() + lane);
  const Held held_a = read_mass(rows.masses.data(), c.a.data() + lane);
  const Held held_b = read_mass(rows.masses.data(), c.b.data() + lane);
  store_masses(held_a, held_b, c, lane);
  const V n = load(c.n, lane), t1 = tangent(n), t2 = cross(n, t1);
  store(t1, c.t1, lane);
  const V belt{load(c.target1, lane), load(c.target2, lane), load(c.target3, lane)};
  store(dot(t1, belt), c.target1, lane);
  store(dot(t2, belt), c.target2, lane);
  const F hs = all(step.hs);
  if (c.turning != WideContact::no_turning)
    prepare_turning(rows.turnings[c.turning], lane, hs, held_a, held_b, n, t1, t2);
  const Four pull_a = read_quad(a.at.data(), 3), pull_b = read_quad(b.at.data(), 3);
  const F pull = dot(n, V{pull_a.c0, pull_a.c1, pull_a.c2} - V{pull_b.c0, pull_b.c1, pull_b.c2});
  LaneFloats counts;
  for (size_t k = 0; k < wide_lanes; ++k) counts[k] = float(c.counts[k]);
  for (uint32_t k = 0; k < c.count; ++k) {
    WidePoint& p = rows.points[c.first + k];
    const V in_a = load(p.ra, lane), in_b = load(p.rb, lane);
    const V ra = in_a + turned_by(held_a.s, held_a.u, in_a);
    const V rb = in_b + turned_by(held_b.s, held_b.u, in_b);
    store(ra, p.ra, lane);
    store(rb, p.rb, lane);
    const M there = hn::Gt(load(counts, lane), all(float(k)));
    set_masses(p, lane, {held_a.mass + held_b.mass, held_a, held_b, ra, rb}, there, n, t1, t2);
    set_impulses(p, lane, hs, t1, t2);
    const V slip = b.v - a.v + cross(b.w, rb) - cross(a.w, ra);
    if (set_bounce(p, lane, n, slip, pull, load(c.restitution, lane), step)) c.bounces = true;
  }
}

void Prepare(WideRows& rows, WideRange range, const WideStep& step) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    rows.contacts[i].bounces = false;
    for (size_t lane = 0; lane < rows.contacts[i].lanes; lane += step_lanes)
      prepare_lanes(rows, rows.contacts[i], lane, step);
  }
}

/// A rotation as a quaternion, and its product with a rotation by omega h by series of sine and
/// cosine, which are exact in single precision up to a radian.
struct Turn {
  F s;
  V u;
};
HWY_INLINE Turn turned(const Turn& q, const V& omega, F h) {
  const F quarter = all(0.25f) * (h * h);
  const F x = quarter * dot(omega, omega);  // half the angle, squared
  const auto term = [](F square, float divisor, F inner)
                        HWY_ATTR { return all(1) - square * all(1 / divisor) * inner; };
  const F one = all(1);
  const F sinc = term(x, 6, term(x, 20, term(x, 42, one)));
  const F cosine = term(x, 2, term(x, 12, term(x, 30, term(x, 56, one))));
  const V axis = (all(0.5f) * h * sinc) * omega;
  F s = cosine * q.s - dot(axis, q.u);
  V u = cosine * q.u + q.s * axis + cross(axis, q.u);
  const F length = hn::Sqrt(s * s + dot(u, u));
  // Both signs are the same rotation; the scalar part is kept positive.
  const F scale = hn::Div(hn::IfThenElse(hn::Lt(s, all(0)), all(-1), all(1)), length);
  return {scale * s, scale * u};
}

/// R m R^-1 v.
HWY_INLINE V conjugated(const Turn& q, const Sym& m, const V& v) {
  const V local = m * (v + turned_by(all(0) - q.s, q.u, v));
  return local + turned_by(q.s, q.u, local);
}

HWY_INLINE void point_at(WideRows& rows, uint32_t block, size_t lane,
                         std::array<float*, step_lanes>& at) {
  for (size_t k = 0; k < step_lanes; ++k)
    at[k] = reinterpret_cast<float*>(rows.bodies.data() + block * wide_lanes + lane + k);
}

template <bool again>
HWY_INLINE void kick(WideRows& rows, WideRange range, float hs) {
  const F h = all(hs);
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideMotion& m = rows.motions[i];
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      std::array<float*, step_lanes> at;
      point_at(rows, i, lane, at);
      const Four q0 = read_quad(at.data(), 0), q1 = read_quad(at.data(), 1);
      const Four pull = read_quad(at.data(), 3);
      const V v{q0.c0, q0.c1, q0.c2}, w{q0.c3, q1.c0, q1.c1};
      V next_v = v + h * V{pull.c0, pull.c1, pull.c2}, next_w = w + h * load(m.alpha, lane);
      const V kicked_v = next_v, kicked_w = next_w;
      if constexpr (again) {
        next_v = next_v + (v - load(m.kicked_v, lane));
        next_w = next_w + (w - load(m.kicked_w, lane));
      }
      store(kicked_v, m.kicked_v, lane);
      store(kicked_w, m.kicked_w, lane);
      write_quad({next_v.x, next_v.y, next_v.z, next_w.x}, at.data(), ~0u, 0);
      write_quad({next_w.y, next_w.z, q1.c2, q1.c3}, at.data(), ~0u, 1);
    }
  }
}

void Kick(WideRows& rows, WideRange range, float hs) {
  kick<false>(rows, range, hs);
}
void KickAgain(WideRows& rows, WideRange range, float hs) {
  kick<true>(rows, range, hs);
}

void Move(WideRows& rows, WideRange range, float hs) {
  const F h = all(hs);
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideMotion& m = rows.motions[i];
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      std::array<float*, step_lanes> at;
      point_at(rows, i, lane, at);
      const Four q0 = read_quad(at.data(), 0), q1 = read_quad(at.data(), 1);
      const Four q2 = read_quad(at.data(), 2);
      const V u{q2.c1, q2.c2, q2.c3};
      const Turn before{scalar_part(u), u};
      V w{q0.c3, q1.c0, q1.c1};
      // Below a small angle per sub-step the gyroscopic term is negligible.
      const M differ = hn::Gt(load(m.gyroscopic, lane), all(0));
      const M turns =
          hn::And(differ, hn::Gt(dot(w, w) * (h * h), all(float(tolerances::gyroscopic_turn2))));
      V mid = w;
      if (!hn::AllFalse(Lanes(), turns)) {
        const Sym inertia = load(m.inertia, lane), inverse = load(m.inverse, lane);
        const V L = conjugated(before, inertia, w);
        for (int k = 0; k < tolerances::midpoint_iterations; ++k) {
          const V next = conjugated(turned(before, mid, all(0.5f) * h), inverse, L);
          mid = choose(turns, next, w);
        }
        const Turn after = turned(before, mid, h);
        const V next = choose(turns, conjugated(after, inverse, L), w);
        // This change is no impulse and must not be repeated by KickAgain.
        store(load(m.kicked_w, lane) + (next - w), m.kicked_w, lane);
        w = next;
      }
      const Turn after = turned(before, mid, h);
      write_quad({q0.c0, q0.c1, q0.c2, w.x}, at.data(), ~0u, 0);
      write_quad({w.y, w.z, q1.c2 + h * q0.c0, q1.c3 + h * q0.c1}, at.data(), ~0u, 1);
      write_quad({q2.c0 + h * q0.c2, after.u.x, after.u.y, after.u.z}, at.data(), ~0u, 2);
    }
  }
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(Prepare);
HWY_EXPORT(Kick);
HWY_EXPORT(KickAgain);
HWY_EXPORT(Move);

void wide_prepare(WideRows& rows, WideRange contacts, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(Prepare)(rows, contacts, step);
}
void wide_kick(WideRows& rows, WideRange motions, float hs) {
  HWY_DYNAMIC_DISPATCH(Kick)(rows, motions, hs);
}
void wide_kick_again(WideRows& rows, WideRange motions, float hs) {
  HWY_DYNAMIC_DISPATCH(KickAgain)(rows, motions, hs);
}
void wide_move(WideRows& rows, WideRange motions, float hs) {
  HWY_DYNAMIC_DISPATCH(Move)(rows, motions, hs);
}

}  // namespace tumble
#endif
