// Vectors of three over lanes in double precision, and grains read by lane. Included once per
// target.
#if defined(TUMBLE_GRAIN_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef TUMBLE_GRAIN_LANES_INL
#undef TUMBLE_GRAIN_LANES_INL
#else
#define TUMBLE_GRAIN_LANES_INL
#endif

#include "engine/dynamics/grains/grain_bundles.hpp"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace tumble::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using GrainD = hn::CappedTag<double, 8>;
using GrainSingle = hn::Rebind<float, GrainD>;
using GrainF = hn::Vec<GrainD>;
/// Lanes computed at once; divides grain_lanes.
constexpr size_t grain_step = hn::MaxLanes(GrainD());
constexpr uint32_t every_lane = (1u << grain_step) - 1;

HWY_INLINE GrainF every_grain(double x) {
  return hn::Set(GrainD(), x);
}
HWY_INLINE GrainF load_grain(const GrainFloats& x, size_t lane) {
  return hn::PromoteTo(GrainD(), hn::Load(GrainSingle(), x.v.data() + lane));
}
HWY_INLINE void store_grain(GrainF x, GrainFloats& to, size_t lane) {
  hn::Store(hn::DemoteTo(GrainSingle(), x), GrainSingle(), to.v.data() + lane);
}

struct GrainV {
  GrainF x, y, z;
};
HWY_INLINE GrainV operator+(const GrainV& a, const GrainV& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
HWY_INLINE GrainV operator-(const GrainV& a, const GrainV& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
HWY_INLINE GrainV operator*(GrainF s, const GrainV& a) {
  return {s * a.x, s * a.y, s * a.z};
}
HWY_INLINE GrainF dot(const GrainV& a, const GrainV& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
HWY_INLINE GrainV cross(const GrainV& a, const GrainV& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
HWY_INLINE GrainV load_grain(const std::array<GrainFloats, 3>& v, size_t lane) {
  return {load_grain(v[0], lane), load_grain(v[1], lane), load_grain(v[2], lane)};
}
HWY_INLINE void store_grain(const GrainV& v, std::array<GrainFloats, 3>& to, size_t lane) {
  store_grain(v.x, to[0], lane);
  store_grain(v.y, to[1], lane);
  store_grain(v.z, to[2], lane);
}
using GrainDoubles = std::array<std::array<double, grain_lanes>, 3>;
HWY_INLINE GrainV load_grain(const GrainDoubles& v, size_t lane) {
  return {hn::Load(GrainD(), v[0].data() + lane), hn::Load(GrainD(), v[1].data() + lane),
          hn::Load(GrainD(), v[2].data() + lane)};
}
HWY_INLINE void store_grain(const GrainV& v, GrainDoubles& to, size_t lane) {
  hn::Store(v.x, GrainD(), to[0].data() + lane);
  hn::Store(v.y, GrainD(), to[1].data() + lane);
  hn::Store(v.z, GrainD(), to[2].data() + lane);
}

/// 1 / x to single precision, or 0 where x is 0.
HWY_INLINE GrainF rough_inverse(GrainF x) {
  const GrainSingle d;
  const auto single = hn::DemoteTo(d, x), one = hn::Set(d, 1.0f);
  const auto positive = hn::Gt(single, hn::Zero(d));
  const auto inverse = hn::Div(one, hn::IfThenElse(positive, single, one));
  return hn::PromoteTo(GrainD(), hn::IfThenElseZero(positive, inverse));
}
/// 1 / sqrt(x) to single precision, or 0 where x is 0.
HWY_INLINE GrainF rough_inverse_root(GrainF x) {
  const GrainSingle d;
  const auto single = hn::DemoteTo(d, x), one = hn::Set(d, 1.0f);
  const auto positive = hn::Gt(single, hn::Zero(d));
  const auto inverse = hn::Div(one, hn::Sqrt(hn::IfThenElse(positive, single, one)));
  return hn::PromoteTo(GrainD(), hn::IfThenElseZero(positive, inverse));
}

/// Two consecutive numbers of each lane: the first of all lanes in `first`, the other in `second`.
struct GrainTwo {
  GrainF first, second;
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE GrainTwo read_two(const double* const* from, size_t offset) {
  return {every_grain(from[0][offset]), every_grain(from[0][offset + 1])};
}
HWY_INLINE void write_two(const GrainTwo& t, double* const* to, uint32_t mask, size_t offset) {
  if (!(mask & 1)) return;
  to[0][offset] = hn::GetLane(t.first);
  to[0][offset + 1] = hn::GetLane(t.second);
}
#else
/// Loads two numbers at `offset` of the lanes `lane`, `lane` + 2, ...: 16 bytes for each.
template <class D>
HWY_INLINE hn::Vec<D> read_grain_blocks(D d, const double* const* from, size_t lane,
                                        size_t offset) {
  if constexpr (hn::MaxLanes(D()) > 2) {
    const hn::Half<D> half;
    return hn::Combine(d, read_grain_blocks(half, from, lane + hn::MaxLanes(half), offset),
                       read_grain_blocks(half, from, lane, offset));
  } else {
    return hn::Load(d, from[lane] + offset);
  }
}
template <class D>
HWY_INLINE void write_grain_blocks(D d, hn::Vec<D> x, double* const* to, uint32_t mask, size_t lane,
                                   size_t offset) {
  if constexpr (hn::MaxLanes(D()) > 2) {
    const hn::Half<D> half;
    write_grain_blocks(half, hn::LowerHalf(half, x), to, mask, lane, offset);
    write_grain_blocks(half, hn::UpperHalf(half, x), to, mask, lane + hn::MaxLanes(half), offset);
  } else {
    if (mask >> lane & 1) hn::Store(x, d, to[lane] + offset);
  }
}
HWY_INLINE GrainTwo read_two(const double* const* from, size_t offset) {
  const GrainD d;
  const GrainF even = read_grain_blocks(d, from, 0, offset);
  const GrainF odd = read_grain_blocks(d, from, 1, offset);
  return {hn::InterleaveLower(d, even, odd), hn::InterleaveUpper(d, even, odd)};
}
/// Lanes whose bit in `mask` is not set are not written.
HWY_INLINE void write_two(const GrainTwo& t, double* const* to, uint32_t mask, size_t offset) {
  const GrainD d;
  write_grain_blocks(d, hn::InterleaveLower(d, t.first, t.second), to, mask, 0, offset);
  write_grain_blocks(d, hn::InterleaveUpper(d, t.first, t.second), to, mask, 1, offset);
}
#endif

/// Velocities of the grains of the lanes, and their addresses.
struct GrainMoving {
  std::array<double*, grain_step> at;
  GrainV v, spin;
  GrainF mass, moment;  ///< inverse mass, inverse moment of inertia

  HWY_INLINE GrainMoving(GrainMover* movers, const uint32_t* index) {
    for (size_t k = 0; k < grain_step; ++k) at[k] = reinterpret_cast<double*>(movers + index[k]);
    const GrainTwo t0 = read_two(at.data(), 0), t1 = read_two(at.data(), 2),
                   t2 = read_two(at.data(), 4), t3 = read_two(at.data(), 6);
    v = {t0.first, t0.second, t1.first};
    mass = t1.second;
    spin = {t2.first, t2.second, t3.first};
    moment = t3.second;
  }
  HWY_INLINE void write(uint32_t mask) const {
    if ((mask & every_lane) == every_lane)
      write_lanes(every_lane);
    else
      write_lanes(mask);
  }

 private:
  HWY_INLINE void write_lanes(uint32_t mask) const {
    write_two({v.x, v.y}, at.data(), mask, 0);
    write_two({v.z, mass}, at.data(), mask, 2);
    write_two({spin.x, spin.y}, at.data(), mask, 4);
    write_two({spin.z, moment}, at.data(), mask, 6);
  }
};
static_assert(sizeof(GrainMover) == 64 && sizeof(GrainPoint) == 32);

/// Positions and radii of the grains of the lanes.
struct GrainSpot {
  std::array<double*, grain_step> at;
  GrainV x;
  GrainF radius;

  HWY_INLINE GrainSpot(GrainPoint* points, const uint32_t* index) {
    for (size_t k = 0; k < grain_step; ++k) at[k] = reinterpret_cast<double*>(points + index[k]);
    const GrainTwo t0 = read_two(at.data(), 0), t1 = read_two(at.data(), 2);
    x = {t0.first, t0.second, t1.first};
    radius = t1.second;
  }
  HWY_INLINE void write(uint32_t mask) const {
    write_two({x.x, x.y}, at.data(), mask, 0);
    write_two({x.z, radius}, at.data(), mask, 2);
  }
};

HWY_INLINE GrainF inverse_masses(const GrainMover* movers, const uint32_t* index) {
  alignas(64) std::array<double, grain_step> m;
  for (size_t k = 0; k < grain_step; ++k) m[k] = movers[index[k]].inverse_mass;
  return hn::Load(GrainD(), m.data());
}

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
