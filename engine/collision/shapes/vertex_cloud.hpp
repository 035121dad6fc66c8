#pragma once
#include "engine/geometry/hull/convex_polyhedron.hpp"
#include "engine/math/triple.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <emmintrin.h>

namespace tumble {

class VertexClimber;

/// Vertices coordinate by coordinate, for scans by SIMD. `padded` is a multiple of four; the last
/// vertex is repeated up to it.
struct VertexCloudView {
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  uint32_t padded = 0;
  const VertexClimber* climber = nullptr;  ///< where climbing is faster than a scan

  Plain3 operator[](uint32_t i) const { return {x[i], y[i], z[i]}; }
};

/// Up to this many vertices a scan is faster than climbing along edges.
constexpr uint32_t vertex_scan_limit = 128;

/// The first of the vertices furthest along d; the same on every machine.
inline uint32_t scan_vertices(const VertexCloudView& v, const Plain3& d);

/// Finds furthest vertices of large polyhedra by climbing along edges.
class VertexClimber {
 public:
  explicit VertexClimber(const ConvexPolyhedron& polyhedron);

  /// A vertex furthest along d up to rounding, from a vertex near there.
  uint32_t climb(const Plain3& d, uint32_t from) const;
  /// The same from the table of directions.
  uint32_t climb(const Plain3& d) const { return climb(d, start_[cell(d)]); }
  /// From `from` or from the table, whichever is higher.
  uint32_t climb_from_nearer(const Plain3& d, uint32_t from) const;
  /// From `from`, which a climb ended at, to a vertex whose height is within 2e-15 reach |d| of the
  /// greatest for certain: all vertices in reach of rounding have been looked round from. Returns
  /// `unsure` when there are too many.
  uint32_t settle(const Plain3& d, uint32_t from, double reach) const;
  static constexpr uint32_t unsure = std::numeric_limits<uint32_t>::max();

  /// Whether the edges are those of the hull of the vertices, up to rounding.
  static bool suits(const ConvexPolyhedron& polyhedron);

 private:
  static constexpr uint32_t cells_per_side = 8;
  static uint32_t cell(const Plain3& d);

  std::vector<Plain3> vertices_;
  std::vector<uint32_t> neighbour_first_, neighbours_;
  std::array<uint32_t, 6 * cells_per_side * cells_per_side> start_{};  ///< on a cube of directions
};

/// The vertices of a polyhedron for support queries; cheap to search for any number of them.
class VertexCloud {
 public:
  explicit VertexCloud(const ConvexPolyhedron& polyhedron);
  VertexCloudView view() const;
  /// Index of a vertex furthest along d.
  uint32_t furthest(const Vec3& d) const;

 private:
  uint32_t padded_ = 0;
  std::vector<double> coordinates_;     ///< all x, all y, all z
  std::vector<VertexClimber> climber_;  ///< one or none
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

/// Of up to eight vertices, all in registers.
inline uint32_t scan_few_vertices(const VertexCloudView& v, const Plain3& d) {
  const __m128d x = _mm_set1_pd(d.x), y = _mm_set1_pd(d.y), z = _mm_set1_pd(d.z);
  const FourHeights first(v, 0, x, y, z), last(v, v.padded - 4, x, y, z);
  __m128d m = _mm_max_pd(first.greater(), last.greater());
  m = _mm_max_pd(m, _mm_shuffle_pd(m, m, 1));
  const int bits = first.equal(m) | last.equal(m) << (v.padded - 4);
  return bits ? uint32_t(__builtin_ctz(unsigned(bits))) : 0;  // none for NaN
}

/// Of any number.
uint32_t scan_many_vertices(const VertexCloudView& v, const Plain3& d);

inline uint32_t scan_vertices(const VertexCloudView& v, const Plain3& d) {
  return v.padded <= 8 ? scan_few_vertices(v, d) : scan_many_vertices(v, d);
}

}  // namespace tumble
