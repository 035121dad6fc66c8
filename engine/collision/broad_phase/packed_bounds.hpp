#pragma once
#include "engine/collision/broad_phase.hpp"
#include "engine/math/float4.hpp"

namespace tumble {

/// The bounds of a proxy relative to an origin, rounded to nearest in single precision. Rounding is
/// monotonic: bounds that are apart here are apart in double too, and bounds that overlap here by
/// strict inequalities overlap in double. The fourth lane holds (0, 1) for a moving proxy and (1,
/// 0) for one at rest, so that two at rest never overlap.
struct PackedBounds {
  Float4 lo, hi;

  void include(const PackedBounds& b) {
    lo = min(lo, b.lo);
    hi = max(hi, b.hi);
  }
};

inline PackedBounds pack(const BroadPhaseProxy& p, const Vec3& origin) {
  const Vec3 lo = p.bounds.min - origin, hi = p.bounds.max - origin;
  const Float4 one(1.0f), zero;
  return {Float4::round(lo.x(), lo.y(), lo.z()).with_fourth(p.moving ? zero : one),
          Float4::round(hi.x(), hi.y(), hi.z()).with_fourth(p.moving ? one : zero)};
}

/// False only if the bounds are apart or both rest.
inline bool may_overlap(const PackedBounds& a, const PackedBounds& b) {
  const __m128 low = _mm_cmple_ps(a.lo.v, b.hi.v), high = _mm_cmple_ps(b.lo.v, a.hi.v);
  return _mm_movemask_ps(_mm_and_ps(low, high)) == 15;
}

/// True only if the bounds overlap in double.
inline bool surely_overlap(const PackedBounds& a, const PackedBounds& b) {
  return (greater(b.hi, a.lo) & greater(a.hi, b.lo) & 7) == 7;
}

}  // namespace tumble
