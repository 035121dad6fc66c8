#include "engine/collision/shapes/support_table.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

/// Fills the cells by recursive bisection of each side of the cube: a vertex discarded for a region
/// need not be considered in its parts.
class SupportTable::Builder {
 public:
  explicit Builder(SupportTable& table) : table_(table) {
    double reach = 0;
    for (const Plain3& v : table.vertices_) reach = std::max(reach, v.squared());
    slack_ = 2e-14 * std::sqrt(reach);
  }

  void run() {
    std::vector<uint32_t> all(table_.vertices_.size());
    for (uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    const uint32_t n = table_.cells_per_side_;
    for (uint32_t side = 0; side < 6; ++side) fill({side, {0, 0}, {n, n}}, all);
  }

 private:
  struct Region {
    uint32_t side;
    std::array<uint32_t, 2> begin, end;

    uint32_t length(size_t k) const { return end[k] - begin[k]; }
  };

  void fill(const Region& region, std::span<const uint32_t> candidates) {
    const std::vector<uint32_t> left = not_below(region, candidates);
    const size_t k = region.length(1) > region.length(0);
    if (region.length(k) == 1) return store(region, left);
    Region part = region;
    part.end[k] = region.begin[k] + region.length(k) / 2;
    fill(part, left);
    part.begin[k] = part.end[k];
    part.end[k] = region.end[k];
    fill(part, left);
  }

  /// The directions through the middle and the corners of a region.
  std::array<Plain3, 5> directions(const Region& r) const {
    std::array<Plain3, 5> out;
    const double n = table_.cells_per_side_;
    for (size_t c = 0; c < 5; ++c) {
      std::array<double, 3> d;
      const size_t axis = r.side / 2;
      d[axis] = r.side % 2 ? -1 : 1;
      for (size_t k = 0; k < 2; ++k) {
        const double a = r.begin[k], b = r.end[k];
        d[(axis + 1 + k) % 3] = 2 * (c == 4 ? 0.5 * (a + b) : c >> k & 1 ? b : a) / n - 1;
      }
      out[c] = {d[0], d[1], d[2]};
    }
    return out;
  }

  /// The candidates that no top vertex exceeds along all corners.
  std::vector<uint32_t> not_below(const Region& region, std::span<const uint32_t> candidates) {
    const std::array<Plain3, 5> along = directions(region);
    std::array<Plain3, 5> tops;
    for (size_t c = 0; c < 5; ++c) {
      double highest = -std::numeric_limits<double>::infinity();
      for (uint32_t v : candidates) {
        const double h = along[c].dot(table_.vertices_[v]);
        if (h > highest) highest = h, tops[c] = table_.vertices_[v];
      }
    }
    const auto below = [&](const Plain3& v) {
      for (const Plain3& top : tops) {
        bool lower = true;
        for (size_t c = 0; c < 4; ++c) lower = lower && along[c].dot(top - v) > slack_;
        if (lower) return true;
      }
      return false;
    };
    std::vector<uint32_t> out;
    for (uint32_t v : candidates)
      if (!below(table_.vertices_[v])) out.push_back(v);
    return out;
  }

  void store(const Region& r, const std::vector<uint32_t>& list) {
    const uint32_t n = table_.cells_per_side_;
    Cell& cell = table_.cells_[(r.side * n + r.begin[0]) * n + r.begin[1]];
    if (list.size() > most_listed) {
      cell = {many, uint32_t(table_.long_lists_.size()), uint32_t(list.size())};
      table_.long_lists_.insert(table_.long_lists_.end(), list.begin(), list.end());
      return;
    }
    for (size_t k = 0; k < most_listed; ++k) cell[k] = list[std::min(k, list.size() - 1)];
  }

  SupportTable& table_;
  double slack_;
};

SupportTable::SupportTable(std::span<const Vec3> vertices) {
  for (const Vec3& v : vertices) vertices_.push_back(Plain3::of(v));
  // two cells a vertex: most lists are short, and the table is no larger than twice the vertices
  cells_per_side_ =
      std::clamp(uint32_t(std::ceil(std::sqrt(double(vertices.size()) / 3))), 1u, 48u);
  half_ = 0.5 * cells_per_side_;
  almost_half_ = half_ * (1 - 1e-15);  // so that the far border is in the last cell
  cells_.resize(6 * size_t(cells_per_side_) * cells_per_side_);
  Builder(*this).run();
}

uint32_t SupportTable::furthest_of(uint32_t first, uint32_t count, const Plain3& d) const {
  uint32_t best = long_lists_[first];
  double height = -std::numeric_limits<double>::infinity();
  for (uint32_t k = first; k < first + count; ++k) {
    const Plain3& v = vertices_[long_lists_[k]];
    const double h = v.dot(d);
    if (h > height) height = h, best = long_lists_[k];
  }
  return best;
}

}  // namespace tumble
