// Vectors of three over lanes, and grains read by lane. Included once per target.
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
using GrainD = hn::CappedTag<float, grain_lanes>;
using GrainF = hn::Vec<GrainD>;
/// Lanes computed at once; divides grain_lanes.
constexpr size_t grain_step = hn::MaxLanes(GrainD());
constexpr uint32_t every_lane = (1u << grain_step) - 1;

HWY_INLINE GrainF every_grain(float x) {
  return hn::Set(GrainD(), x);
}
HWY_INLINE GrainF load_grain(const GrainFloats& x, size_t lane) {
  return hn::Load(GrainD(), x.v.data() + lane);
}
HWY_INLINE void store_grain(GrainF x, GrainFloats& to, size_t lane) {
  hn::Store(x, GrainD(), to.v.data() + lane);
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

/// 1 / x, or 0 where x is 0.
HWY_INLINE GrainF inverse_or_zero(GrainF x) {
  const auto positive = hn::Gt(x, every_grain(0));
  return hn::IfThenElseZero(positive, every_grain(1) / hn::IfThenElse(positive, x, every_grain(1)));
}

/// Four consecutive numbers of each lane: the first of all lanes in `x`, and so on.
struct GrainFour {
  GrainF x, y, z, w;
};

#if HWY_TARGET == HWY_SCALAR
HWY_INLINE GrainFour read_four(const float* const* from, size_t offset) {
  const float* at = from[0] + offset;
  return {every_grain(at[0]), every_grain(at[1]), every_grain(at[2]), every_grain(at[3])};
}
HWY_INLINE void write_four(const GrainFour& t, float* const* to, uint32_t mask, size_t offset) {
  if (!(mask & 1)) return;
  float* at = to[0] + offset;
  at[0] = hn::GetLane(t.x), at[1] = hn::GetLane(t.y);
  at[2] = hn::GetLane(t.z), at[3] = hn::GetLane(t.w);
}
#else
/// Loads four numbers at `offset` of the lanes `lane`, `lane` + 4, ...: 16 bytes for each.
template <class D>
HWY_INLINE hn::Vec<D> read_grain_blocks(D d, const float* const* from, size_t lane, size_t offset) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    return hn::Combine(d, read_grain_blocks(half, from, lane + hn::MaxLanes(half), offset),
                       read_grain_blocks(half, from, lane, offset));
  } else {
    return hn::LoadU(d, from[lane] + offset);
  }
}
template <class D>
HWY_INLINE void write_grain_blocks(D d, hn::Vec<D> x, float* const* to, uint32_t mask, size_t lane,
                                   size_t offset) {
  if constexpr (hn::MaxLanes(D()) > 4) {
    const hn::Half<D> half;
    write_grain_blocks(half, hn::LowerHalf(half, x), to, mask, lane, offset);
    write_grain_blocks(half, hn::UpperHalf(half, x), to, mask, lane + hn::MaxLanes(half), offset);
  } else {
    if (mask >> lane & 1) hn::StoreU(x, d, to[lane] + offset);
  }
}
/// Transposes four by four numbers in each block of 16 bytes; its own inverse.
HWY_INLINE GrainFour transposed(const GrainFour& t) {
  const GrainD d;
  const GrainF even_low = hn::InterleaveLower(d, t.x, t.z);
  const GrainF odd_low = hn::InterleaveLower(d, t.y, t.w);
  const GrainF even_high = hn::InterleaveUpper(d, t.x, t.z);
  const GrainF odd_high = hn::InterleaveUpper(d, t.y, t.w);
  return {hn::InterleaveLower(d, even_low, odd_low), hn::InterleaveUpper(d, even_low, odd_low),
          hn::InterleaveLower(d, even_high, odd_high), hn::InterleaveUpper(d, even_high, odd_high)};
}
HWY_INLINE GrainFour read_four(const float* const* from, size_t offset) {
  const GrainD d;
  return transposed({read_grain_blocks(d, from, 0, offset), read_grain_blocks(d, from, 1, offset),
                     read_grain_blocks(d, from, 2, offset), read_grain_blocks(d, from, 3, offset)});
}
/// Lanes whose bit in `mask` is not set are not written.
HWY_INLINE void write_four(const GrainFour& t, float* const* to, uint32_t mask, size_t offset) {
  const GrainD d;
  const GrainFour by_lane = transposed(t);
  write_grain_blocks(d, by_lane.x, to, mask, 0, offset);
  write_grain_blocks(d, by_lane.y, to, mask, 1, offset);
  write_grain_blocks(d, by_lane.z, to, mask, 2, offset);
  write_grain_blocks(d, by_lane.w, to, mask, 3, offset);
}
#endif

/// Velocities of the grains of the lanes, and their addresses.
struct GrainMoving {
  std::array<float*, grain_step> at;
  GrainV v, spin;
  GrainF mass, moment;  ///< inverse mass, inverse moment of inertia

  HWY_INLINE GrainMoving(GrainRow* rows, const uint32_t* index) {
    for (size_t k = 0; k < grain_step; ++k) at[k] = rows[index[k]].v.data();
    const GrainFour t0 = read_four(at.data(), 0), t1 = read_four(at.data(), 4);
    v = {t0.x, t0.y, t0.z};
    mass = t0.w;
    spin = {t1.x, t1.y, t1.z};
    moment = t1.w;
  }
  HWY_INLINE void write(uint32_t mask) const {
    if ((mask & every_lane) == every_lane)
      write_lanes(every_lane);
    else
      write_lanes(mask);
  }

 private:
  HWY_INLINE void write_lanes(uint32_t mask) const {
    write_four({v.x, v.y, v.z, mass}, at.data(), mask, 0);
    write_four({spin.x, spin.y, spin.z, moment}, at.data(), mask, 4);
  }
};
static_assert(sizeof(GrainRow) == 32 && sizeof(GrainShift) == 16);

/// Displacements of the grains of the lanes.
struct GrainShifting {
  std::array<float*, grain_step> at;
  GrainV x;
  GrainF mass;  ///< inverse mass

  HWY_INLINE GrainShifting(GrainShift* shifts, const uint32_t* index) {
    for (size_t k = 0; k < grain_step; ++k) at[k] = shifts[index[k]].x.data();
    const GrainFour t = read_four(at.data(), 0);
    x = {t.x, t.y, t.z};
    mass = t.w;
  }
  HWY_INLINE void write(uint32_t mask) const {
    write_four({x.x, x.y, x.z, mass}, at.data(), mask, 0);
  }
};

}  // namespace tumble::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
