#include "engine/collision/shapes/vertex_cloud.hpp"

#include <algorithm>

#include <immintrin.h>

namespace tumble {

namespace {

/// The best so far, and a block of vertices. Chosen without a jump: which block is best cannot be
/// foreseen.
struct BestOfBlocks {
  uint32_t vertex = 0;
  double height = -std::numeric_limits<double>::infinity();

  /// Bit k of `highest`: vertex k of the block has the greatest height `most`.
  void offer(double most, unsigned highest, uint32_t block) {
    const uint32_t first = block + uint32_t(__builtin_ctz(highest | 1u << 31));
    const bool better = most > height;
    vertex = better ? first : vertex;
    height = better ? most : height;
  }
};

uint32_t scan_by_two(const VertexCloudView& v, const Plain3& d) {
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

#if defined(__x86_64__)
__attribute__((target("avx"))) uint32_t scan_by_four(const VertexCloudView& v, const Plain3& d) {
  const __m256d x = _mm256_set1_pd(d.x), y = _mm256_set1_pd(d.y), z = _mm256_set1_pd(d.z);
  BestOfBlocks best;
  for (uint32_t i = 0; i < v.padded; i += scan_block) {
    __m256d h[4];
    for (uint32_t k = 0; k < 4; ++k) {
      const uint32_t at = i + 4 * k;
      const __m256d xy = _mm256_add_pd(_mm256_mul_pd(_mm256_loadu_pd(v.x + at), x),
                                       _mm256_mul_pd(_mm256_loadu_pd(v.y + at), y));
      h[k] = _mm256_add_pd(xy, _mm256_mul_pd(_mm256_loadu_pd(v.z + at), z));
    }
    __m256d m = _mm256_max_pd(_mm256_max_pd(h[0], h[1]), _mm256_max_pd(h[2], h[3]));
    m = _mm256_max_pd(m, _mm256_permute2f128_pd(m, m, 1));
    m = _mm256_max_pd(m, _mm256_permute_pd(m, 5));
    int bits = 0;
    for (uint32_t k = 0; k < 4; ++k)
      bits |= _mm256_movemask_pd(_mm256_cmp_pd(h[k], m, _CMP_EQ_OQ)) << 4 * k;
    best.offer(_mm256_cvtsd_f64(m), unsigned(bits), i);
  }
  return best.vertex;
}
const auto scan_fast = __builtin_cpu_supports("avx") ? scan_by_four : scan_by_two;
#else
const auto scan_fast = scan_by_two;
#endif

}  // namespace

uint32_t scan_many_vertices(const VertexCloudView& v, const Plain3& d) {
  return scan_fast(v, d);
}

VertexCloud::VertexCloud(std::span<const Vec3> vertices) {
  const auto count = uint32_t(vertices.size());
  const uint32_t multiple = count <= few_vertices ? 4 : scan_block;
  padded_ = (count + multiple - 1) / multiple * multiple;
  coordinates_.resize(3 * padded_);
  for (uint32_t i = 0; i < padded_; ++i) {
    const Vec3& v = vertices[std::min(size_t(i), vertices.size() - 1)];
    for (uint32_t k = 0; k < 3; ++k) coordinates_[k * padded_ + i] = v[int(k)];
  }
  if (count > scan_limit) table_.emplace(vertices);
}

VertexCloudView VertexCloud::view() const {
  const double* x = coordinates_.data();
  return {x, x + padded_, x + 2 * padded_, padded_, table_ ? &*table_ : nullptr};
}

uint32_t VertexCloud::furthest(const Vec3& d) const {
  return furthest_vertex(view(), Plain3::of(d));
}

}  // namespace tumble
