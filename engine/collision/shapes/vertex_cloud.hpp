#pragma once
#include "engine/collision/shapes/support_table.hpp"

#include <optional>

namespace tumble {

/// Arrays of vertex coordinates for SIMD. `padded` is 4, 8, or a multiple of 16; the last vertex is
/// repeated up to it.
struct VertexCloudView {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  uint32_t padded = 0;
  const SupportTable* table = nullptr;  ///< if it is faster than a scan

  Plain3 operator[](uint32_t i) const { return {x[i], y[i], z[i]}; }
};

/// The vertices of a polyhedron for support queries, fast for any number of them.
class VertexCloud {
 public:
  explicit VertexCloud(std::span<const Vec3> vertices);
  VertexCloudView view() const;
  /// Index of a vertex furthest along d.
  uint32_t furthest(const Vec3& d) const;

 private:
  uint32_t padded_ = 0;
  std::vector<double> coordinates_;  ///< all x, all y, all z
  std::optional<SupportTable> table_;
};

// -- the scan ---------------------------------------------------------------------------------

/// Heights of four vertices, two by two.
struct FourHeights {
  __m128d low, high;

  FourHeights(const VertexCloudView& v, uint32_t i, __m128d x, __m128d y, __m128d z)
      : low(two(v, i, x, y, z)), high(two(v, i + 2, x, y, z)) {}
  __m128d greater() const { return _mm_max_pd(low, high); }
  /// Bit k: height k is m.
  int equal(__m128d m) const {
    return _mm_movemask_pd(_mm_cmpeq_pd(low, m)) | _mm_movemask_pd(_mm_cmpeq_pd(high, m)) << 2;
  }
  static __m128d two(const VertexCloudView& v, uint32_t k, __m128d x, __m128d y, __m128d z) {
    const __m128d xy =
        _mm_add_pd(_mm_mul_pd(_mm_loadu_pd(v.x + k), x), _mm_mul_pd(_mm_loadu_pd(v.y + k), y));
    return _mm_add_pd(xy, _mm_mul_pd(_mm_loadu_pd(v.z + k), z));
  }
};

/// Up to this many vertices fit into the registers, and a scan is faster than a table.
constexpr uint32_t few_vertices = 8;

/// The first of the few vertices furthest along d; the same on every machine.
inline uint32_t scan_few_vertices(const VertexCloudView& v, const Plain3& d) {
  const __m128d x = _mm_set1_pd(d.x), y = _mm_set1_pd(d.y), z = _mm_set1_pd(d.z);
  const FourHeights first(v, 0, x, y, z), last(v, v.padded - 4, x, y, z);
  __m128d m = _mm_max_pd(first.greater(), last.greater());
  m = _mm_max_pd(m, _mm_shuffle_pd(m, m, 1));
  const int bits = first.equal(m) | last.equal(m) << (v.padded - 4);
  return bits ? uint32_t(__builtin_ctz(unsigned(bits))) : 0;  // none for NaN
}

/// Up to this many vertices a scan is faster than a table.
constexpr uint32_t scan_limit = 64;
/// More than a few vertices are scanned in blocks of this many.
constexpr uint32_t scan_block = 16;

/// The first of the vertices furthest along d; the same on every machine.
uint32_t scan_many_vertices(const VertexCloudView& v, const Plain3& d);

inline uint32_t furthest_vertex(const VertexCloudView& v, const Plain3& d) {
  return v.table                    ? v.table->furthest(d)
         : v.padded <= few_vertices ? scan_few_vertices(v, d)
                                    : scan_many_vertices(v, d);
}

}  // namespace tumble
