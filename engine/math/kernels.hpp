#pragma once
#include <cstddef>

#include <emmintrin.h>

/// Inner loops whose bits depend on nothing but their input: sums use two pairs of SSE2 lanes,
/// which every x86-64 machine has, and are added in one order; element-wise loops have no order.
namespace tumble {

/// a . b
inline double dot(const double* a, const double* b, int n) {
  __m128d s0 = _mm_setzero_pd(), s1 = s0, s2 = s0, s3 = s0;
  int i = 0;
  for (; i + 8 <= n; i += 8) {
    s0 = _mm_add_pd(s0, _mm_mul_pd(_mm_loadu_pd(a + i), _mm_loadu_pd(b + i)));
    s1 = _mm_add_pd(s1, _mm_mul_pd(_mm_loadu_pd(a + i + 2), _mm_loadu_pd(b + i + 2)));
    s2 = _mm_add_pd(s2, _mm_mul_pd(_mm_loadu_pd(a + i + 4), _mm_loadu_pd(b + i + 4)));
    s3 = _mm_add_pd(s3, _mm_mul_pd(_mm_loadu_pd(a + i + 6), _mm_loadu_pd(b + i + 6)));
  }
  const __m128d s = _mm_add_pd(_mm_add_pd(s0, s1), _mm_add_pd(s2, s3));
  double sum = _mm_cvtsd_f64(s) + _mm_cvtsd_f64(_mm_unpackhi_pd(s, s));
  for (; i < n; ++i) sum += a[i] * b[i];
  return sum;
}

/// out[k] = a_k . b for four columns a_k = a + k stride.
inline void dot4(const double* a, std::ptrdiff_t stride, const double* b, int n, double* out) {
  const double *a0 = a, *a1 = a + stride, *a2 = a1 + stride, *a3 = a2 + stride;
  __m128d s0 = _mm_setzero_pd(), s1 = s0, s2 = s0, s3 = s0, t0 = s0, t1 = s0, t2 = s0, t3 = s0;
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    const __m128d x = _mm_loadu_pd(b + i), y = _mm_loadu_pd(b + i + 2);
    s0 = _mm_add_pd(s0, _mm_mul_pd(_mm_loadu_pd(a0 + i), x));
    s1 = _mm_add_pd(s1, _mm_mul_pd(_mm_loadu_pd(a1 + i), x));
    s2 = _mm_add_pd(s2, _mm_mul_pd(_mm_loadu_pd(a2 + i), x));
    s3 = _mm_add_pd(s3, _mm_mul_pd(_mm_loadu_pd(a3 + i), x));
    t0 = _mm_add_pd(t0, _mm_mul_pd(_mm_loadu_pd(a0 + i + 2), y));
    t1 = _mm_add_pd(t1, _mm_mul_pd(_mm_loadu_pd(a1 + i + 2), y));
    t2 = _mm_add_pd(t2, _mm_mul_pd(_mm_loadu_pd(a2 + i + 2), y));
    t3 = _mm_add_pd(t3, _mm_mul_pd(_mm_loadu_pd(a3 + i + 2), y));
  }
  const auto level = [](__m128d s, __m128d t) {
    const __m128d u = _mm_add_pd(s, t);
    return _mm_cvtsd_f64(u) + _mm_cvtsd_f64(_mm_unpackhi_pd(u, u));
  };
  double r0 = level(s0, t0), r1 = level(s1, t1), r2 = level(s2, t2), r3 = level(s3, t3);
  for (; i < n; ++i) {
    r0 += a0[i] * b[i];
    r1 += a1[i] * b[i];
    r2 += a2[i] * b[i];
    r3 += a3[i] * b[i];
  }
  out[0] = r0, out[1] = r1, out[2] = r2, out[3] = r3;
}

/// y += f x
inline void add_scaled(double* __restrict y, double f, const double* __restrict x, int n) {
  for (int i = 0; i < n; ++i) y[i] += f * x[i];
}

/// y += f0 x0 + f1 x1 + f2 x2 + f3 x3, from the left.
inline void add_scaled4(double* __restrict y, double f0, const double* __restrict x0, double f1,
                        const double* __restrict x1, double f2, const double* __restrict x2,
                        double f3, const double* __restrict x3, int n) {
  for (int i = 0; i < n; ++i) y[i] = (((y[i] + f0 * x0[i]) + f1 * x1[i]) + f2 * x2[i]) + f3 * x3[i];
}

/// y += the sum over k of f[k] times column columns[k] of a; columns are `stride` apart.
inline void add_columns(double* y, const double* a, std::ptrdiff_t stride, const int* columns,
                        const double* f, int count, int n) {
  int k = 0;
  for (; k + 4 <= count; k += 4) {
    add_scaled4(y, f[k], a + columns[k] * stride, f[k + 1], a + columns[k + 1] * stride, f[k + 2],
                a + columns[k + 2] * stride, f[k + 3], a + columns[k + 3] * stride, n);
  }
  for (; k < count; ++k) add_scaled(y, f[k], a + columns[k] * stride, n);
}

}  // namespace tumble
