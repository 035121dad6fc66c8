// Rows of joints at the present poses, a bundle at a time; the same in scalars: refresh_joints in
// realtime/solve_joints.cpp.
#include "engine/dynamics/realtime/wide/wide_kernels.hpp"

// Compiles this file once per instruction set, with the includes that each time needs.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "engine/dynamics/realtime/wide/joint_refresh_kernels.cpp"
#include <hwy/foreach_target.h>
#include "engine/dynamics/realtime/wide/joint_rows-inl.hpp"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

/// As factorise_kept in kept_rows.hpp, all rows being kept.
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
    k[j].x[j] = hn::IfThenElseZero(hn::Gt(d, all(tolerances::dependent_row_single) * diagonal),
                                   hn::Div(all(1), d));
    for (size_t i = j + 1; i < n; ++i)
      for (size_t m = 0; m < j; ++m) k[i].x[j] = k[i].x[j] - k[i].x[m] * k[j].x[m];
  }
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

/// Mobility by a body's rotation of a point with arm r: column by column (I (r x e)) x r for unit
/// impulses e.
HWY_INLINE Sym turning_mobility(const Sym& i, const V& r) {
  const V x{i.xy * r.z - i.xz * r.y, i.yy * r.z - i.yz * r.y, i.yz * r.z - i.zz * r.y};
  const V y{i.xz * r.x - i.xx * r.z, i.yz * r.x - i.xy * r.z, i.zz * r.x - i.xz * r.z};
  const V z{i.xx * r.y - i.xy * r.x, i.xy * r.y - i.yy * r.x, i.xz * r.y - i.yz * r.x};
  return {x.y * r.z - x.z * r.y, y.y * r.z - y.z * r.y, z.y * r.z - z.z * r.y,
          y.z * r.x - y.x * r.z, z.z * r.x - z.x * r.z, z.x * r.y - z.y * r.x};
}

/// The present pose and angular velocity of a body of a joint.
struct Placed {
  V dx, w, u;  ///< displacement, angular velocity, vector part of the rotation since the start
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
  // Chosen by lane, so that a joint of spheres has the same bits beside one of boxes.
  const M uneven = hn::Gt(load(j.uneven, lane), all(0));
  store(choose(uneven, rotated(held_a.inertia, a.s, a.u), load(j.inertia_a, lane)), j.inertia_a,
        lane);
  store(choose(uneven, rotated(held_b.inertia, b.s, b.u), load(j.inertia_b, lane)), j.inertia_b,
        lane);
}

/// See followed_share() in joint_lines.hpp.
HWY_INLINE F followed_share(const Placed& a, const Placed& b, const WideStep& step) {
  const F most = all(float(tolerances::max_turn_per_substep * tolerances::max_turn_per_substep) /
                     (step.hs * step.hs));
  const F square = hn::Max(dot(a.w, a.w), dot(b.w, b.w));
  return hn::IfThenElse(hn::Gt(square, most), hn::Div(most, square), all(1));
}

HWY_INLINE F bounded(F correction) {
  const F most = all(float(tolerances::max_joint_correction));
  return hn::Max(hn::Min(correction, most), all(0) - most);
}
HWY_INLINE V bounded(const V& correction) {
  return {bounded(correction.x), bounded(correction.y), bounded(correction.z)};
}

/// Computes errors and arms. Targets are the velocities whose removal makes the end of the
/// sub-step, C + hs J v + hs^2/2 (dJ/dt v), keep its error or reduce it.
HWY_INLINE void refresh_point(WideJoint& j, size_t lane, const Placed& a, const Placed& b,
                              const WideStep& step, F share) {
  const V at_a = load(j.at_a, lane), at_b = load(j.at_b, lane);
  const V moved_a = turned_by(a.s, a.u, at_a), moved_b = turned_by(b.s, b.u, at_b);
  const V ra = at_a + moved_a, rb = at_b + moved_b;
  const V error = load(j.apart, lane) + ((b.dx - a.dx) + (moved_b - moved_a));
  const V bias = cross(b.w, cross(b.w, rb)) - cross(a.w, cross(a.w, ra));
  store(ra, j.ra, lane);
  store(rb, j.rb, lane);
  store(all(0.5f * step.hs) * share * bias, j.target, lane);
  store(bounded(all(step.joint_rate) * error), j.correction, lane);
}

/// As dot_row in joint_algebra.cpp.
HWY_INLINE void refresh_hinge(WideHinge& h, size_t lane, const Placed& a, const Placed& b,
                              const WideStep& step, F share) {
  const V z = b.turn(load(h.z_b, lane));
  const V z_rate = cross(b.w, z);
  for (size_t k = 0; k < 2; ++k) {
    const V u = a.turn(load(k == 0 ? h.x_a : h.y_a, lane));
    const V turn_rate = cross(z_rate, u) + cross(z, cross(a.w, u));
    store(cross(z, u), h.turn[k], lane);
    store(all(0.5f * step.hs) * share * dot(turn_rate, b.w - a.w), h.target[k], lane);
    store(bounded(all(step.joint_rate) * dot(u, z)), h.correction[k], lane);
  }
}

/// Computes and factorises K = J M^-1 J^T.
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

HWY_INLINE void refresh_lanes(WideRows& rows, WideJoint& j, WideHinge* h, size_t lane,
                              const WideStep& step) {
  const Placed a(Moving(rows.bodies.data(), j.a.data() + lane));
  const Placed b(Moving(rows.bodies.data(), j.b.data() + lane));
  if (j.any_uneven) set_inertia(rows, j, lane, a, b);
  const F share = followed_share(a, b, step);
  refresh_point(j, lane, a, b, step, share);
  if (h) {
    refresh_hinge(*h, lane, a, b, step, share);
    set_effective_mass<5>(j, h, lane);
  } else {
    set_effective_mass<3>(j, nullptr, lane);
  }
}

void RefreshJoints(WideRows& rows, WideRange range, const WideStep& step) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    for (size_t lane = 0; lane < j.lanes; lane += step_lanes)
      refresh_lanes(rows, j, hinge_of(rows, j), lane, step);
  }
}

void PrepareJoints(WideRows& rows, WideRange range, const WideStep& step) {
  for (uint32_t i = range.begin; i < range.end; ++i) {
    WideJoint& j = rows.joints[i];
    for (size_t lane = 0; lane < j.lanes; lane += step_lanes) {
      store_masses(read_mass(rows.masses.data(), j.a.data() + lane),
                   read_mass(rows.masses.data(), j.b.data() + lane), j, lane);
    }
  }
  RefreshJoints(rows, range, step);
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tumble {

HWY_EXPORT(PrepareJoints);
HWY_EXPORT(RefreshJoints);

void wide_prepare_joints(WideRows& rows, WideRange joints, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(PrepareJoints)(rows, joints, step);
}
void wide_refresh_joints(WideRows& rows, WideRange joints, const WideStep& step) {
  HWY_DYNAMIC_DISPATCH(RefreshJoints)(rows, joints, step);
}

}  // namespace tumble
#endif
