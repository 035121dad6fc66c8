#pragma once
#include "engine/collision/shapes/vertex_cloud.hpp"

#include <immintrin.h>

/// Scans of vertices as types, for loops that are compiled for each register width. All find the
/// same vertices, with the same rounding. For the wider registers the whole loop must be one
/// function with the target attribute and `flatten`, so that the scan is inlined.
namespace tumble {

/// The best vertex so far, updated by blocks. Without branches, since the best block cannot be
/// predicted.
struct BestOfBlocks {
  uint32_t vertex = 0;
  double height = -std::numeric_limits<double>::infinity();

  /// Bit k of `highest` is set if vertex k of the block has its greatest height, `most`.
  void offer(double most, unsigned highest, uint32_t block) {
    const uint32_t first = block + uint32_t(__builtin_ctz(highest | 1u << 31));
    const uint32_t better = -uint32_t(most > height);
    vertex ^= (vertex ^ first) & better;
    height = most > height ? most : height;
  }
};

/// In registers of two numbers, which every machine has.
struct ScanByTwo {
  static uint32_t few(const VertexCloudView& v, const Plain3& d) { return scan_few_vertices(v, d); }
  /// The vertex of v extreme along -d, and that of w extreme along d.
  static void opposite_few(const VertexCloudView& v, const VertexCloudView& w, const Plain3& d,
                           uint32_t& of_v, uint32_t& of_w) {
    of_v = few(v, -d);
    of_w = few(w, d);
  }

  static uint32_t many(const VertexCloudView& v, const Plain3& d) {
    const __m128d x = _mm_set1_pd(d.x), y = _mm_set1_pd(d.y), z = _mm_set1_pd(d.z);
    BestOfBlocks best;
    for (uint32_t i = 0; i < v.padded; i += scan_block) {
      const FourHeights a(v, i, x, y, z), b(v, i + 4, x, y, z), c(v, i + 8, x, y, z),
          e(v, i + 12, x, y, z);
      __m128d m =
          _mm_max_pd(_mm_max_pd(a.greater(), b.greater()), _mm_max_pd(c.greater(), e.greater()));
      m = _mm_max_pd(m, _mm_shuffle_pd(m, m, 1));
      best.offer(_mm_cvtsd_f64(m),
                 unsigned(a.equal(m) | b.equal(m) << 4 | c.equal(m) << 8 | e.equal(m) << 12), i);
    }
    return best.vertex;
  }

  /// row * v + shift for all vertices of a small cloud.
  static void turn(const VertexCloudView& v, const Plain3& row, double shift, double* to) {
    const __m128d x = _mm_set1_pd(row.x), y = _mm_set1_pd(row.y), z = _mm_set1_pd(row.z),
                  t = _mm_set1_pd(shift);
    for (uint32_t i = 0; i < v.padded; i += 2)
      _mm_store_pd(to + i, _mm_add_pd(FourHeights::two(v, i, x, y, z), t));
  }

  /// Multiplies by the transpose of a rotation that is given by columns; writes three numbers, with
  /// room for a fourth.
  static void turn_back(const double* R, double x, double y, double z, double* to) {
    for (size_t k = 0; k < 3; ++k) to[k] = R[3 * k] * x + R[3 * k + 1] * y + R[3 * k + 2] * z;
  }
};

#if defined(__x86_64__)
#define TUMBLE_AVX [[gnu::target("avx")]]

/// In registers of four numbers.
struct ScanByFour {
  TUMBLE_AVX static uint32_t few(const VertexCloudView& v, const Plain3& d) {
    const __m256d x = _mm256_set1_pd(d.x), y = _mm256_set1_pd(d.y), z = _mm256_set1_pd(d.z);
    const uint32_t second = v.padded - 4;
    const __m256d h0 = heights(v, 0, x, y, z), h1 = heights(v, second, x, y, z);
    return first_of_few(h0, h1, greatest(_mm256_max_pd(h0, h1)), second);
  }
  TUMBLE_AVX static void opposite_few(const VertexCloudView& v, const VertexCloudView& w,
                                      const Plain3& d, uint32_t& of_v, uint32_t& of_w) {
    const __m256d x = _mm256_set1_pd(d.x), y = _mm256_set1_pd(d.y), z = _mm256_set1_pd(d.z);
    const uint32_t second_v = v.padded - 4, second_w = w.padded - 4;
    const __m256d v0 = heights(v, 0, x, y, z), v1 = heights(v, second_v, x, y, z);
    const __m256d w0 = heights(w, 0, x, y, z), w1 = heights(w, second_w, x, y, z);
    of_v = first_of_few(v0, v1, least(_mm256_min_pd(v0, v1)), second_v);
    of_w = first_of_few(w0, w1, greatest(_mm256_max_pd(w0, w1)), second_w);
  }

  TUMBLE_AVX static uint32_t many(const VertexCloudView& v, const Plain3& d) {
    const __m256d x = _mm256_set1_pd(d.x), y = _mm256_set1_pd(d.y), z = _mm256_set1_pd(d.z);
    BestOfBlocks best;
    for (uint32_t i = 0; i < v.padded; i += scan_block) {
      const __m256d a = heights(v, i, x, y, z), b = heights(v, i + 4, x, y, z),
                    c = heights(v, i + 8, x, y, z), e = heights(v, i + 12, x, y, z);
      const __m256d m = greatest(_mm256_max_pd(_mm256_max_pd(a, b), _mm256_max_pd(c, e)));
      best.offer(_mm256_cvtsd_f64(m),
                 unsigned(equal(a, m) | equal(b, m) << 4 | equal(c, m) << 8 | equal(e, m) << 12),
                 i);
    }
    return best.vertex;
  }

  TUMBLE_AVX static void turn(const VertexCloudView& v, const Plain3& row, double shift,
                              double* to) {
    const __m256d x = _mm256_set1_pd(row.x), y = _mm256_set1_pd(row.y), z = _mm256_set1_pd(row.z),
                  t = _mm256_set1_pd(shift);
    const uint32_t second = v.padded - 4;
    _mm256_storeu_pd(to, _mm256_add_pd(heights(v, 0, x, y, z), t));
    _mm256_storeu_pd(to + second, _mm256_add_pd(heights(v, second, x, y, z), t));
  }
  TUMBLE_AVX static void turn_back(const double* R, double x, double y, double z, double* to) {
    const __m256d xy = _mm256_add_pd(_mm256_mul_pd(strided(R), _mm256_set1_pd(x)),
                                     _mm256_mul_pd(strided(R + 1), _mm256_set1_pd(y)));
    _mm256_store_pd(to, _mm256_add_pd(xy, _mm256_mul_pd(strided(R + 2), _mm256_set1_pd(z))));
  }

 private:
  TUMBLE_AVX static __m256d strided(const double* p) { return _mm256_set_pd(0, p[6], p[3], p[0]); }
  /// Index of the first height in two blocks that equals m; the last for NaN.
  TUMBLE_AVX static uint32_t first_of_few(const __m256d& h0, const __m256d& h1, const __m256d& m,
                                          uint32_t second) {
    const unsigned bits = unsigned(equal(h0, m)) | unsigned(equal(h1, m) | 8) << second;
    return uint32_t(__builtin_ctz(bits));
  }
  TUMBLE_AVX static __m256d heights(const VertexCloudView& v, uint32_t i, const __m256d& x,
                                    const __m256d& y, const __m256d& z) {
    const __m256d xy = _mm256_add_pd(_mm256_mul_pd(_mm256_loadu_pd(v.x + i), x),
                                     _mm256_mul_pd(_mm256_loadu_pd(v.y + i), y));
    return _mm256_add_pd(xy, _mm256_mul_pd(_mm256_loadu_pd(v.z + i), z));
  }
  /// The greatest of four numbers, in all four places.
  TUMBLE_AVX static __m256d greatest(__m256d m) {
    m = _mm256_max_pd(m, _mm256_permute2f128_pd(m, m, 1));
    return _mm256_max_pd(m, _mm256_permute_pd(m, 5));
  }
  TUMBLE_AVX static __m256d least(__m256d m) {
    m = _mm256_min_pd(m, _mm256_permute2f128_pd(m, m, 1));
    return _mm256_min_pd(m, _mm256_permute_pd(m, 5));
  }
  TUMBLE_AVX static int equal(const __m256d& h, const __m256d& m) {
    return _mm256_movemask_pd(_mm256_cmp_pd(h, m, _CMP_EQ_OQ));
  }
};
#endif

}  // namespace tumble
