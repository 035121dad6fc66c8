// Sweeps over joints, eight at a time; scalar twin: joints/solve_joints.cpp.
#include "engine/dynamics/contact/wide/wide_kernels.hpp"

// This file once per instruction set, then what each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/contact/wide/joint_kernels.cpp"
#include <hwy/foreach_target.h>
#include "engine/dynamics/contact/wide/lanes-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// The two bodies of some lanes of a bundle of joints.
struct Ends {
  Moving a, b;
  F mass_a, mass_b;
  Sym inertia_a, inertia_b;
  V ra, rb;

  HWY_INLINE Ends(WideRows& rows, const WideJoint& j, size_t lane)
      : a(rows.bodies.data(), j.a.data() + lane),
        b(rows.bodies.data(), j.b.data() + lane),
        mass_a(load(j.mass_a, lane)),
        mass_b(load(j.mass_b, lane)),
        inertia_a(load(j.inertia_a, lane)),
        inertia_b(load(j.inertia_b, lane)),
        ra(load(j.ra, lane)),
        rb(load(j.rb, lane)) {}
  HWY_INLINE V slip() const { return b.v - a.v + cross(b.w, rb) - cross(a.w, ra); }
  /// Impulse P on B and -P on A at the anchors, and likewise a moment T.
  HWY_INLINE void push(const V& P, const V* T) {
    V on_a = cross(ra, P), on_b = cross(rb, P);
    if (T) {
      on_a = on_a + *T;
      on_b = on_b + *T;
    }
    a.v = a.v - mass_a * P;
    a.w = a.w - inertia_a * on_a;
    b.v = b.v + mass_b * P;
    b.w = b.w + inertia_b * on_b;
  }
  HWY_INLINE void write(const WideJoint& j, size_t lane) const {
    a.write(uint32_t(j.writes_a) >> lane);
    b.write(uint32_t(j.writes_b) >> lane);
  }
};

/// Rows of a joint: three of the anchors, and two of a hinge.
template <size_t n>
struct Column {
  F x[n];
};

/// The triangle of WideJoint::factor and WideHinge::factor.
template <size_t n>
HWY_INLINE Eight& entry(WideJoint& j, WideHinge* h, size_t row, size_t column) {
  const size_t k = row * (row + 1) / 2 + column;
  if constexpr (n > 3) {
    if (k >= 6) return h->factor[k - 6];
  }
  return j.factor[k];
}

/// As factorise in solve_joints.cpp.
template <size_t n>
HWY_INLINE void factorise(Column<n> (&k)[n]) {
  for (size_t j = 0; j < n; ++j) {
    const F diagonal = k[j].x[j];
    F scaled[n];
    for (size_t m = 0; m < j; ++m) {
      scaled[m] = k[j].x[m];  // L D
      k[j].x[m] = k[j].x[m] * k[m].x[m];
    }
    F d = diagonal;
    for (size_t m = 0; m < j; ++m) d = d - scaled[m] * k[j].x[m];
    k[j].x[j] = hn::IfThenElseZero(hn::Gt(d, all(1e-6f) * diagonal), hn::Div(all(1), d));
    for (size_t i = j + 1; i < n; ++i)
      for (size_t m = 0; m < j; ++m) k[i].x[j] = k[i].x[j] - k[i].x[m] * k[j].x[m];
  }
}

template <size_t n>
HWY_INLINE void solve_factored(WideJoint& j, WideHinge* h, size_t lane, Column<n>& c) {
  const auto at = [&](size_t row, size_t column)
                      HWY_ATTR { return load(entry<n>(j, h, row, column), lane); };
  for (size_t i = 0; i < n; ++i)
    for (size_t m = 0; m < i; ++m) c.x[i] = c.x[i] - at(i, m) * c.x[m];
  for (size_t i = 0; i < n; ++i) c.x[i] = c.x[i] * at(i, i);
  for (size_t i = n; i-- > 0;)
    for (size_t m = i + 1; m < n; ++m) c.x[i] = c.x[i] - at(m, i) * c.x[m];
}

/// R m R^-1 for the rotation by the unit quaternion (s, u).
HWY_INLINE Sym rotated(const Sym& m, F s, const V& u) {
  const F one = all(1), two = all(2);
  const F xx = two * u.x * u.x, yy = two * u.y * u.y, zz = two * u.z * u.z;
  const F xy = two * u.x * u.y, xz = two * u.x * u.z, yz = two * u.y * u.z;
  const F sx = two * s * u.x, sy = two * s * u.y, sz = two * s * u.z;
  const V x{one - yy - zz, xy - sz, xz + sy};
  const V y{xy + sz, one - xx - zz, yz - sx};
  const V z{xz - sy, yz + sx, one - xx - yy};
  const V mx = m * x, my = m * y, mz = m * z;
  return {dot(x, mx), dot(x, my), dot(x, mz), dot(y, my), dot(y, mz), dot(z, mz)};
}

/// What a body's rotation adds to the mobility of a point with arm r: the sum over unit impulses e
/// of (I (r x e)) x r.
HWY_INLINE Sym turning_mobility(const Sym& i, const V& r) {
  const V x{i.xy * r.z - i.xz * r.y, i.yy * r.z - i.yz * r.y, i.yz * r.z - i.zz * r.y};
  const V y{i.xz * r.x - i.xx * r.z, i.yz * r.x - i.xy * r.z, i.zz * r.x - i.xz * r.z};
  const V z{i.xx * r.y - i.xy * r.x, i.xy * r.y - i.yy * r.x, i.xz * r.y - i.yz * r.x};
  return {x.y * r.z - x.z * r.y, y.y * r.z - y.z * r.y, z.y * r.z - z.z * r.y,
          y.z * r.x - y.x * r.z, z.z * r.x - z.x * r.z, z.x * r.y - z.y * r.x};
}

/// A body of a joint where it is now.
struct Placed {
  V dx, w, u;  ///< displacement, angular velocity, vector part of the turn since the start
  F s;         ///< its scalar part
  HWY_INLINE explicit Placed(const Moving& m) : w(m.w) {
    const Four q = read_quad(m.at.data(), 2);
    dx = {m.dx0, m.dx1, q.c0};
    u = {q.c1, q.c2, q.c3};
    s = scalar_part(u);
  }
  HWY_INLINE V turn(const V& v) const { return v + turned_by(s, u, v); }
};

HWY_INLINE void set_inertia(const WideRows& rows, WideJoint& j, size_t lane, const Placed& a,
                            const Placed& b) {
  const Held held_a = read_mass(rows.masses.data(), j.a.data() + lane);
  const Held held_b = read_mass(rows.masses.data(), j.b.data() + lane);
  store(rotated(held_a.inertia, a.s, a.u), j.inertia_a, lane);
  store(rotated(held_b.inertia, b.s, b.u), j.inertia_b, lane);
}

/// Errors and arms. The target is what brings the end of the sub-step, C + hs J v + hs^2/2 (dJ/dt
/// v), onto the joint.
HWY_INLINE void refresh_point(WideJoint& j, size_t lane, const Placed& a, const Placed& b,
                              const WideStep& step) {
  const V at_a = load(j.at_a, lane), at_b = load(j.at_b, lane);
  const V moved_a = turned_by(a.s, a.u, at_a), moved_b = turned_by(b.s, b.u, at_b);
  const V ra = at_a + moved_a, rb = at_b + moved_b;
  const V error = load(j.apart, lane) + ((b.dx - a.dx) + (moved_b - moved_a));
  const V bias = cross(b.w, cross(b.w, rb)) - cross(a.w, cross(a.w, ra));
  store(ra, j.ra, lane);
  store(rb, j.rb, lane);
  store(all(step.joint.bias_rate) * error + all(0.5f * step.hs) * bias, j.target, lane);
}

/// As dot_row in joint_algebra.cpp.
HWY_INLINE void refresh_hinge(WideHinge& h, size_t lane, const Placed& a, const Placed& b,
                              const WideStep& step) {
  const V z = b.turn(load(h.z_b, lane));
  const V z_rate = cross(b.w, z);
  for (size_t k = 0; k < 2; ++k) {
    const V u = a.turn(load(k == 0 ? h.x_a : h.y_a, lane));
    const V turn_rate = cross(z_rate, u) + cross(z, cross(a.w, u));
    store(cross(z, u), h.turn[k], lane);
    store(all(step.joint.bias_rate) * dot(u, z) + all(0.5f * step.hs) * dot(turn_rate, b.w - a.w),
          h.target[k], lane);
  }
}

/// K = J M^-1 J^T, factorised.
template <size_t n>
HWY_INLINE void set_effective_mass(WideJoint& j, WideHinge* h, size_t lane) {
  const Sym ia = load(j.inertia_a, lane), ib = load(j.inertia_b, lane);
  const V ra = load(j.ra, lane), rb = load(j.rb, lane);
  const Sym ka = turning_mobility(ia, ra), kb = turning_mobility(ib, rb);
  const F mass = load(j.mass_a, lane) + load(j.mass_b, lane);
  Column<n> k[n];
  k[0].x[0] = mass + ka.xx + kb.xx;
  k[1].x[0] = ka.xy + kb.xy;
  k[1].x[1] = mass + ka.yy + kb.yy;
  k[2].x[0] = ka.xz + kb.xz;
  k[2].x[1] = ka.yz + kb.yz;
  k[2].x[2] = mass + ka.zz + kb.zz;
  if constexpr (n == 5) {
    for (size_t i = 0; i < 2; ++i) {
      const V turn = load(h->turn[i], lane);
      const V wa = ia * turn, wb = ib * turn;
      const V coupling = cross(wa, ra) + cross(wb, rb);
      Column<n>& row = k[3 + i];
      row.x[0] = coupling.x;
      row.x[1] = coupling.y;
      row.x[2] = coupling.z;
      for (size_t m = 0; m <= i; ++m) row.x[3 + m] = dot(wa + wb, load(h->turn[m], lane));
    }
  }
  factorise<n>(k);
  for (size_t i = 0; i < n; ++i)
    for (size_t m = 0; m <= i; ++m) store(k[i].x[m], entry<n>(j, h, i, m), lane);
}

HWY_INLINE WideHinge* hinge_of(WideRows& rows, const WideJoint& j) {
  return j.hinge == WideJoint::no_hinge ? nullptr : &rows.hinges[j.hinge];
}

HWY_INLINE void refresh_lanes(WideRows& rows, WideJoint& j, WideHinge* h, size_t lane,
                              const WideStep& step) {
  const Placed a(Moving(rows.bodies.data(), j.a.data() + lane));
  const Placed b(Moving(rows.bodies.data(), j.b.data() + lane));
  if (j.uneven) set_inertia(rows, j, lane, a, b);
  refresh_point(j, lane, a, b, step);
  if (h) {
    refresh_hinge(*h, lane, a, b, step);
    set_effective_mass<5>(j, h, lane);
  } else {
    set_effective_mass<3>(j, nullptr, lane);
  }
}

void RefreshJoints(WideRows& rows, WideRange range, const WideStep& step) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes)
      refresh_lanes(rows, j, hinge_of(rows, j), lane, step);
  }
}

void PrepareJoints(WideRows& rows, WideRange range, const WideStep& step) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      const Held a = read_mass(rows.masses.data(), j.a.data() + lane);
      const Held b = read_mass(rows.masses.data(), j.b.data() + lane);
      store(a.mass, j.mass_a, lane);
      store(b.mass, j.mass_b, lane);
      store(a.inertia, j.inertia_a, lane);
      store(b.inertia, j.inertia_b, lane);
    }
  }
  RefreshJoints(rows, range, step);
}

HWY_INLINE V moment(const WideHinge& h, size_t lane, F first, F second) {
  return first * load(h.turn[0], lane) + second * load(h.turn[1], lane);
}

void WarmStartJoints(WideRows& rows, WideRange range, JointPass pass) {
  const bool moving = pass == JointPass::moving;
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    const WideHinge* h = hinge_of(rows, j);
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      Ends ends(rows, j, lane);
      const V P = load(moving ? j.moving : j.relaxing, lane);
      if (h) {
        const std::array<Eight, 2>& twist = moving ? h->moving : h->relaxing;
        const V T = moment(*h, lane, load(twist[0], lane), load(twist[1], lane));
        ends.push(P, &T);
      } else {
        ends.push(P, nullptr);
      }
      ends.write(j, lane);
    }
  }
}

HWY_INLINE void add(const V& v, EightVec& to, size_t lane) {
  store(load(to, lane) + v, to, lane);
}

void SumJoints(WideRows& rows, WideRange range, JointPass pass) {
  const bool moving = pass == JointPass::moving;
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    const WideHinge* h = hinge_of(rows, j);
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      const V P = load(moving ? j.moving : j.relaxing, lane);
      V on_a = cross(P, load(j.ra, lane)), on_b = cross(load(j.rb, lane), P);
      if (h) {
        const std::array<Eight, 2>& twist = moving ? h->moving : h->relaxing;
        const V T = moment(*h, lane, load(twist[0], lane), load(twist[1], lane));
        on_a = on_a - T;
        on_b = on_b + T;
      }
      add(P, j.impulse, lane);
      add(on_a, j.moment_a, lane);
      add(on_b, j.moment_b, lane);
    }
  }
}

/// Velocities of the rows.
template <size_t n>
HWY_INLINE Column<n> velocities(const Ends& ends, const WideHinge* h, size_t lane) {
  const V slip = ends.slip();
  Column<n> c;
  c.x[0] = slip.x;
  c.x[1] = slip.y;
  c.x[2] = slip.z;
  if constexpr (n == 5) {
    const V spin = ends.b.w - ends.a.w;
    c.x[3] = dot(load(h->turn[0], lane), spin);
    c.x[4] = dot(load(h->turn[1], lane), spin);
  }
  return c;
}

template <size_t n, JointPass pass>
HWY_INLINE void solve_lanes(WideRows& rows, WideJoint& j, WideHinge* h, size_t lane,
                            const WideSoftness& soft) {
  constexpr bool moving = pass == JointPass::moving;
  Ends ends(rows, j, lane);
  Column<n> c = velocities<n>(ends, h, lane);
  if constexpr (moving) {
    for (size_t k = 0; k < 3; ++k) c.x[k] = c.x[k] + load(j.target[k], lane);
    for (size_t k = 3; k < n; ++k) c.x[k] = c.x[k] + load(h->target[k - 3], lane);
  }
  solve_factored<n>(j, h, lane, c);
  for (size_t k = 0; k < n; ++k) {
    Eight& impulse = k < 3 ? (moving ? j.moving : j.relaxing)[k]
                           : (moving ? h->moving : h->relaxing)[k < 3 ? 0 : k - 3];
    const F old = load(impulse, lane);
    if constexpr (moving) {
      c.x[k] = all(-soft.mass_scale) * c.x[k] - all(soft.impulse_scale) * old;
    } else {
      c.x[k] = all(0) - c.x[k];
    }
    store(old + c.x[k], impulse, lane);
  }
  const V P{c.x[0], c.x[1], c.x[2]};
  if constexpr (n == 5) {
    const V T = moment(*h, lane, c.x[3], c.x[4]);
    ends.push(P, &T);
  } else {
    ends.push(P, nullptr);
  }
  ends.write(j, lane);
}

template <JointPass pass>
HWY_INLINE void sweep_joints(WideRows& rows, WideRange range, const WideSoftness& soft) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    WideHinge* const h = hinge_of(rows, j);
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      if (h) {
        solve_lanes<5, pass>(rows, j, h, lane, soft);
      } else {
        solve_lanes<3, pass>(rows, j, nullptr, lane, soft);
      }
    }
  }
}

void SolveJoints(WideRows& rows, WideRange range, const WideStep& step, JointPass pass) {
  if (pass == JointPass::moving) {
    sweep_joints<JointPass::moving>(rows, range, step.joint);
  } else {
    sweep_joints<JointPass::relaxing>(rows, range, step.joint);
  }
}

float JointResidual(WideRows& rows, WideRange range) {
  F most = all(0);
  for (uint32_t i = range.begin; i < range.end; ++i) {
    const WideJoint& j = rows.joints[i];
    const WideHinge* const h = hinge_of(rows, j);
    for (size_t lane = 0; lane < wide_lanes; lane += step_lanes) {
      const Ends ends(rows, j, lane);
      const Column<3> c = velocities<3>(ends, nullptr, lane);
      for (const F& x : c.x) most = hn::Max(most, hn::Abs(x));
      if (!h) continue;
      const V spin = ends.b.w - ends.a.w;
      for (const EightVec& turn : h->turn)
        most = hn::Max(most, hn::Abs(dot(load(turn, lane), spin)));
    }
  }
  Eight lanes;
  store(most, lanes, 0);
  float greatest = 0;
  for (size_t k = 0; k < step_lanes; ++k) greatest = lanes[k] > greatest ? lanes[k] : greatest;
  return greatest;
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(PrepareJoints);
HWY_EXPORT(RefreshJoints);
HWY_EXPORT(WarmStartJoints);
HWY_EXPORT(SolveJoints);
HWY_EXPORT(SumJoints);
HWY_EXPORT(JointResidual);

void wide_prepare_joints(WideRows& rows, WideRange joints, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(PrepareJoints)(rows, joints, step);
}
void wide_refresh_joints(WideRows& rows, WideRange joints, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(RefreshJoints)(rows, joints, step);
}
void wide_warm_start_joints(WideRows& rows, WideRange joints, JointPass pass) {
  HWY_DYNAMIC_DISPATCH(WarmStartJoints)(rows, joints, pass);
}
void wide_solve_joints(WideRows& rows, WideRange joints, const WideStep& step, JointPass pass) {
  HWY_DYNAMIC_DISPATCH(SolveJoints)(rows, joints, step, pass);
}
void wide_sum_joints(WideRows& rows, WideRange joints, JointPass pass) {
  HWY_DYNAMIC_DISPATCH(SumJoints)(rows, joints, pass);
}
float wide_joint_residual(WideRows& rows, WideRange joints) {
  return HWY_DYNAMIC_DISPATCH(JointResidual)(rows, joints);
}

}  // namespace tumble
#endif
