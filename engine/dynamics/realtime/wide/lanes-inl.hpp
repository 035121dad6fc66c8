// Vectors of three over the lanes of a SIMD vector, and bodies read by lane. Included once per
// target.
#if defined(TUMBLE_WIDE_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUMBLE_WIDE_LANES_INL
#undef TUMBLE_WIDE_LANES_INL
#else
#define TUMBLE_WIDE_LANES_INL
#endif

#include "engine/dynamics/realtime/wide/wide_rows.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, wide_lanes>;
using F = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
/// Lanes computed at once; divides wide_lanes.
constexpr size_t step_lanes = hn::MaxLanes(Lanes());

HWY_INLINE F all(float x) {
  return hn::Set(Lanes(), x);
}
HWY_INLINE F load(const LaneFloats& x, size_t lane) {
  return hn::Load(Lanes(), x.v.data() + lane);
}
HWY_INLINE void store(F x, LaneFloats& to, size_t lane) {
  hn::Store(x, Lanes(), to.v.data() + lane);
}
/// 1 / x, or 0 where x is not positive.
HWY_INLINE F inverse(F x) {
  const M positive = hn::Gt(x, all(0));
  return hn::IfThenElseZero(positive, hn::Div(all(1), x));
}

struct V {
  F x, y, z;
};
HWY_INLINE V operator+(const V& a, const V& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE V operator-(const V& a, const V& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE V operator*(F s, const V& a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE F dot(const V& a, const V& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE V cross(const V& a, const V& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE V choose(M m, const V& yes, const V& no) {
  return {hn::IfThenElse(m, yes.x, no.x), hn::IfThenElse(m, yes.y, no.y),
          hn::IfThenElse(m, yes.z, no.z)};
}
HWY_INLINE V load(const LaneVec& v, size_t lane) {
  return {load(v[0], lane), load(v[1], lane), load(v[2], lane)};
}
HWY_INLINE void store(const V& v, LaneVec& to, size_t lane) {
  store(v.x, to[0], lane);
  store(v.y, to[1], lane);
  store(v.z, to[2], lane);
}

/// A symmetric matrix.
struct Sym {
  F xx, xy, xz, yy, yz, zz;
};
HWY_INLINE V operator*(const Sym& m, const V& a) {
  return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
          m.xz * a.x + m.yz * a.y + m.zz * a.z};
}
HWY_INLINE Sym load(const LaneSym& m, size_t lane) {
  return {load(m[0], lane), load(m[1], lane), load(m[2], lane),
          load(m[3], lane), load(m[4], lane), load(m[5], lane)};
}
HWY_INLINE Sym choose(M m, const Sym& yes, const Sym& no) {
  return {hn::IfThenElse(m, yes.xx, no.xx), hn::IfThenElse(m, yes.xy, no.xy),
          hn::IfThenElse(m, yes.xz, no.xz), hn::IfThenElse(m, yes.yy, no.yy),
          hn::IfThenElse(m, yes.yz, no.yz), hn::IfThenElse(m, yes.zz, no.zz)};
}
HWY_INLINE void store(const Sym& m, LaneSym& to, size_t lane) {
  store(m.xx, to[0], lane);
  store(m.xy, to[1], lane);
  store(m.xz, to[2], lane);
  store(m.yy, to[3], lane);
  store(m.yz, to[4], lane);
  store(m.zz, to[5], lane);
}

/// R v - v for the rotation R by the unit quaternion (s, u).
HWY_INLINE V turned_by(F s, const V& u, const V& v) {
  const V c = cross(u, v);
  const V twice = s * c + cross(u, c);
  return twice + twice;
}
/// The scalar part (not negative) of a unit quaternion with this vector part.
HWY_INLINE F scalar_part(const V& u) {
  return hn::Sqrt(hn::Max(all(0), all(1) - dot(u, u)));
}

/// Four consecutive floats of each lane: component k of all lanes is in ck.
struct Four {
  F c0, c1, c2, c3;
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE Four read_quad(const float* const* from, size_t quad) {
  const float* p = from[0] + 4 * quad;
  return {all(p[0]), all(p[1]), all(p[2]), all(p[3])};
}
HWY_INLINE void write_quad(const Four& q, float* const* to, uint32_t mask, size_t quad) {
  if (!(mask & 1)) return;
  float* p = to[0] + 4 * quad;
  p[0] = hn::GetLane(q.c0);
  p[1] = hn::GetLane(q.c1);
  p[2] = hn::GetLane(q.c2);
  p[3] = hn::GetLane(q.c3);
}
#else
/// Transposes 4 x 4 floats within every block of four lanes; its own inverse.
HWY_INLINE Four transposed(const Four& r) {
  const Lanes d;
  const hn::Repartition<double, Lanes> pairs;
  const F low01 = hn::InterleaveLower(d, r.c0, r.c1), low23 = hn::InterleaveLower(d, r.c2, r.c3);
  const F high01 = hn::InterleaveUpper(d, r.c0, r.c1), high23 = hn::InterleaveUpper(d, r.c2, r.c3);
  const auto l01 = hn::BitCast(pairs, low01), l23 = hn::BitCast(pairs, low23);
  const auto h01 = hn::BitCast(pairs, high01), h23 = hn::BitCast(pairs, high23);
  return {hn::BitCast(d, hn::InterleaveLower(pairs, l01, l23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, l01, l23)),
          hn::BitCast(d, hn::InterleaveLower(pairs, h01, h23)),
          hn::BitCast(d, hn::InterleaveUpper(pairs, h01, h23))};
}

/// Loads four floats at `offset` of the lanes `lane`, `lane` + 4, ...: one block for each.
template <class D>
HWY_INLINE hn::Vec<D> read_blocks(D d, const float* const* from, size_t lane, size_t offset) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return hn::Combine(d, read_blocks(half, from, lane + hn::MaxLanes(half), offset),
                       read_blocks(half, from, lane, offset));
  } else {
    return hn::Load(d, from[lane] + offset);
  }
}
template <class D>
HWY_INLINE void write_blocks(D d, hn::Vec<D> x, float* const* to, uint32_t mask, size_t lane,
                             size_t offset) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    write_blocks(half, hn::LowerHalf(half, x), to, mask, lane, offset);
    write_blocks(half, hn::UpperHalf(half, x), to, mask, lane + hn::MaxLanes(half), offset);
  } else {
    if (mask >> lane & 1) hn::Store(x, d, to[lane] + offset);
  }
}
HWY_INLINE Four read_quad(const float* const* from, size_t quad) {
  const Lanes d;
  return transposed({read_blocks(d, from, 0, 4 * quad), read_blocks(d, from, 1, 4 * quad),
                     read_blocks(d, from, 2, 4 * quad), read_blocks(d, from, 3, 4 * quad)});
}
/// Lanes whose bit in `mask` is not set are not written.
HWY_INLINE void write_quad(const Four& q, float* const* to, uint32_t mask, size_t quad) {
  const Four r = transposed(q);
  const Lanes d;
  write_blocks(d, r.c0, to, mask, 0, 4 * quad);
  write_blocks(d, r.c1, to, mask, 1, 4 * quad);
  write_blocks(d, r.c2, to, mask, 2, 4 * quad);
  write_blocks(d, r.c3, to, mask, 3, 4 * quad);
}
#endif

/// Velocities of the bodies of the lanes, and their addresses.
struct Moving {
  std::array<float*, step_lanes> at;
  V v, w;
  F dx0, dx1;  ///< displacement x and y, in one quad with w

  HWY_INLINE Moving(WideBody* bodies, const uint32_t* index) {
    for (size_t k = 0; k < step_lanes; ++k) at[k] = reinterpret_cast<float*>(bodies + index[k]);
    const Four q0 = read_quad(at.data(), 0), q1 = read_quad(at.data(), 1);
    v = {q0.c0, q0.c1, q0.c2};
    w = {q0.c3, q1.c0, q1.c1};
    dx0 = q1.c2;
    dx1 = q1.c3;
  }
  HWY_INLINE void write(uint32_t mask) const {
    write_quad({v.x, v.y, v.z, w.x}, at.data(), mask, 0);
    write_quad({w.y, w.z, dx0, dx1}, at.data(), mask, 1);
  }
};
static_assert(sizeof(WideBody) == 64 && sizeof(WideMass) == 64);

/// The contents of WideMass for the bodies of the lanes.
struct Held {
  V u;  ///< vector part of the orientation at the start
  F s, mass;
  Sym inertia;
};

HWY_INLINE Held read_mass(const WideMass* masses, const uint32_t* index) {
  std::array<const float*, step_lanes> at;
  for (size_t k = 0; k < step_lanes; ++k) at[k] = reinterpret_cast<const float*>(masses + index[k]);
  const Four q = read_quad(at.data(), 0), m = read_quad(at.data(), 1), i = read_quad(at.data(), 2);
  return {{q.c0, q.c1, q.c2}, q.c3, m.c0, {m.c1, m.c2, m.c3, i.c0, i.c1, i.c2}};
}

/// Stores the masses of both bodies in a bundle of contacts or joints.
template <class Bundle>
HWY_INLINE void store_masses(const Held& a, const Held& b, Bundle& to, size_t lane) {
  store(a.mass, to.mass_a, lane);
  store(b.mass, to.mass_b, lane);
  store(a.inertia, to.inertia_a, lane);
  store(b.inertia, to.inertia_b, lane);
}

/// The greatest of the lanes of one vector, or 0.
HWY_INLINE float greatest_lane(F values) {
  LaneFloats lanes;
  store(values, lanes, 0);
  float greatest = 0;
  for (size_t k = 0; k < step_lanes; ++k) greatest = lanes[k] > greatest ? lanes[k] : greatest;
  return greatest;
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
