#pragma once
#include <array>
#include <cstdint>
#include <cstring>

#include <emmintrin.h>

namespace tumble {

/// Four floats, an operation on all at once: the baseline of x86-64 (SSE2), so that every machine
/// computes the same bits. Comparisons give one bit per lane.
struct Float4 {
  __m128 v;

  Float4() : v(_mm_setzero_ps()) {}
  Float4(__m128 x) : v(x) {}
  explicit Float4(float x) : v(_mm_set1_ps(x)) {}
  Float4(float x, float y, float z, float w) : v(_mm_setr_ps(x, y, z, w)) {}

  /// Three doubles rounded to nearest, the fourth lane 0. By intrinsics, because g++ 12 may omit
  /// the rounding when it vectorises double(float(x)).
  static Float4 round(double x, double y, double z) {
    return _mm_movelh_ps(_mm_cvtpd_ps(_mm_setr_pd(x, y)), _mm_cvtpd_ps(_mm_setr_pd(z, 0)));
  }
  /// Four consecutive floats, at any address.
  static Float4 load(const float* p) { return _mm_loadu_ps(p); }
  void store(float* p) const { _mm_storeu_ps(p, v); }
  std::array<float, 4> array() const {
    std::array<float, 4> out;
    store(out.data());
    return out;
  }
  /// Lane k in all lanes.
  template <int k>
  Float4 spread() const {
    return _mm_shuffle_ps(v, v, _MM_SHUFFLE(k, k, k, k));
  }
  /// Lanes a, b, c, d in this order.
  template <int a, int b, int c, int d>
  Float4 shuffled() const {
    return _mm_shuffle_ps(v, v, _MM_SHUFFLE(d, c, b, a));
  }
  /// The first three lanes, the fourth 0.
  Float4 xyz() const { return _mm_and_ps(v, _mm_castsi128_ps(_mm_setr_epi32(-1, -1, -1, 0))); }
  /// The first three lanes, and the fourth of `other`.
  Float4 with_fourth(Float4 other) const {
    const __m128 high = _mm_shuffle_ps(v, other.v, _MM_SHUFFLE(3, 3, 2, 2));
    return _mm_shuffle_ps(v, high, _MM_SHUFFLE(2, 0, 1, 0));
  }
  float first() const { return _mm_cvtss_f32(v); }

  friend Float4 operator+(Float4 a, Float4 b) { return _mm_add_ps(a.v, b.v); }
  friend Float4 operator-(Float4 a, Float4 b) { return _mm_sub_ps(a.v, b.v); }
  friend Float4 operator*(Float4 a, Float4 b) { return _mm_mul_ps(a.v, b.v); }
};

inline Float4 abs(Float4 a) {
  return _mm_andnot_ps(_mm_set1_ps(-0.0f), a.v);
}
inline Float4 min(Float4 a, Float4 b) {
  return _mm_min_ps(a.v, b.v);
}
inline Float4 max(Float4 a, Float4 b) {
  return _mm_max_ps(a.v, b.v);
}
/// Bit k: a > b in lane k.
inline int greater(Float4 a, Float4 b) {
  return _mm_movemask_ps(_mm_cmpgt_ps(a.v, b.v));
}
/// Smallest and largest of the four lanes.
inline float least(Float4 a) {
  const Float4 b = min(a, a.shuffled<2, 3, 0, 1>());
  return min(b, b.shuffled<1, 0, 3, 2>()).first();
}
inline float most(Float4 a) {
  const Float4 b = max(a, a.shuffled<2, 3, 0, 1>());
  return max(b, b.shuffled<1, 0, 3, 2>()).first();
}

/// A 3 x 3 matrix by rows; fourth lanes 0.
struct Rows3 {
  std::array<Float4, 3> row;

  static Rows3 identity() { return {{Float4(1, 0, 0, 0), Float4(0, 1, 0, 0), Float4(0, 0, 1, 0)}}; }
  Rows3 transposed() const {
    __m128 a = row[0].v, b = row[1].v, c = row[2].v, d = _mm_setzero_ps();
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return {{Float4(a), Float4(b), Float4(c)}};
  }
  /// Sum of the rows weighted by the components of x: the transposed matrix times x.
  Float4 combine(Float4 x) const {
    return row[0] * x.spread<0>() + row[1] * x.spread<1>() + row[2] * x.spread<2>();
  }
  Rows3 absolute() const { return {{abs(row[0]), abs(row[1]), abs(row[2])}}; }
};

/// Scalar product of the first three lanes, summed in order.
inline float dot3(Float4 a, Float4 b) {
  const Float4 m = a * b;
  return m.first() + m.spread<1>().first() + m.spread<2>().first();
}

}  // namespace tumble
