#pragma once
#include "engine/math/triple.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <emmintrin.h>

namespace tumble {

/// Support vertex of a large set in a direction, at a cost that hardly grows with the number of
/// vertices. The directions are divided into the cells of a grid on the sides of a cube. Each cell
/// lists all vertices that are extreme for some of its directions; these few heights are compared.
/// There is no walk, and no branch that depends on the direction.
///
/// A vertex is not listed in a cell if another one is higher along the directions of the cell's
/// four corners: any direction between them is a sum of these with nonnegative weights, so that it
/// is lower for all of them. It must be lower by more than rounding errors, so that no list lacks
/// the extreme vertex.
class SupportTable {
 public:
  explicit SupportTable(std::span<const Vec3> vertices);

  /// The first of the vertices whose height along d (any length), rounded, is the greatest.
  uint32_t furthest(const Plain3& d) const;

 private:
  static constexpr uint32_t most_listed = 4;
  /// Vertices in ascending order, the last repeated to fill the cell; or, if there are more, `many`
  /// and the start and length of a list in long_lists_.
  using Cell = std::array<uint32_t, most_listed>;
  static constexpr uint32_t many = std::numeric_limits<uint32_t>::max();
  class Builder;

  uint32_t cell(const Plain3& d) const;
  uint32_t furthest_of(uint32_t first, uint32_t count, const Plain3& d) const;

  std::vector<Plain3> vertices_;
  uint32_t cells_per_side_;
  double half_, almost_half_;  ///< half the number of cells along a side
  std::vector<Cell> cells_;
  std::vector<uint32_t> long_lists_;
};

inline uint32_t SupportTable::cell(const Plain3& d) const {
  const std::array<double, 5> p{d.x, d.y, d.z, d.x, d.y};
  const double sx = std::abs(d.x), sy = std::abs(d.y), sz = std::abs(d.z);
  const bool z = (sz > sx) & (sz > sy), y = !z & (sy > sx);
  const auto axis = size_t(2 * z + y);
  const double scale = almost_half_ / std::abs(p[axis]);
  const auto place = [&](double x) {
    const auto at = uint32_t(_mm_cvttsd_si32(_mm_set_sd(x * scale + half_)));
    return std::min(at, cells_per_side_ - 1);  // only matters for NaN
  };
  const auto side = uint32_t(2 * axis + (p[axis] < 0));
  return (side * cells_per_side_ + place(p[axis + 1])) * cells_per_side_ + place(p[axis + 2]);
}

inline uint32_t SupportTable::furthest(const Plain3& d) const {
  const Cell& list = cells_[cell(d)];
  if (list[0] == many) return furthest_of(list[1], list[2], d);
  const __m128d x = _mm_set1_pd(d.x), y = _mm_set1_pd(d.y), z = _mm_set1_pd(d.z);
  const auto two = [&](size_t k) {
    const Plain3 &p = vertices_[list[k]], &q = vertices_[list[k + 1]];
    const auto both = [](const double& a, const double& b) {
      return _mm_loadh_pd(_mm_load_sd(&a), &b);
    };
    const __m128d xy = _mm_add_pd(_mm_mul_pd(both(p.x, q.x), x), _mm_mul_pd(both(p.y, q.y), y));
    return _mm_add_pd(xy, _mm_mul_pd(both(p.z, q.z), z));
  };
  const __m128d h0 = two(0), h1 = two(2);
  __m128d m = _mm_max_pd(h0, h1);
  m = _mm_max_pd(m, _mm_shuffle_pd(m, m, 1));
  const int bits = _mm_movemask_pd(_mm_cmpeq_pd(h0, m)) | _mm_movemask_pd(_mm_cmpeq_pd(h1, m)) << 2;
  return list[size_t(__builtin_ctz(unsigned(bits | 1 << 4))) % most_listed];  // the first for NaN
}

}  // namespace tumble
