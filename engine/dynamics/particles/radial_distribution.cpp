#include "engine/dynamics/particles/radial_distribution.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tumble {
namespace {

using CellKey = std::array<int64_t, 3>;

/// Points by the cells of a grid of at least `range`; along periodic axes the last cell is next to
/// the first.
class RadialCells {
 public:
  RadialCells(std::span<const Vec3> points, const PeriodicBox& box, double range)
      : points_(points), box_(box) {
    for (int k = 0; k < 3; ++k) {
      count_[size_t(k)] = box.along(k) ? std::max<int64_t>(1, int64_t(box.size[k] / range)) : 0;
      edge_[k] = box.along(k) ? box.size[k] / double(count_[size_t(k)]) : range;
    }
    for (uint32_t i = 0; i < points.size(); ++i) members_.push_back({key_of(points[i]), i});
    std::ranges::sort(members_);
  }

  /// Calls f(squared distance) for every pair of points in neighbouring cells, once.
  template <class F>
  void for_pairs(const F& f) const {
    for (size_t first = 0; first < members_.size();) {
      const auto [begin, end] = cell(members_[first].key);
      for (const CellKey& near : neighbours(members_[first].key)) {
        const auto [from, to] = cell(near);
        for (size_t a = begin; a < end; ++a)
          for (size_t b = std::max(from, a + 1); b < to; ++b)
            f(box_.shortest(point(b) - point(a)).squaredNorm());
      }
      first = end;
    }
  }

 private:
  struct Member {
    CellKey key;
    uint32_t index;
    auto operator<=>(const Member&) const = default;
  };

  const Vec3& point(size_t member) const { return points_[members_[member].index]; }
  CellKey key_of(const Vec3& x) const {
    CellKey key{};
    for (int k = 0; k < 3; ++k)
      key[size_t(k)] = int64_t(std::floor((x[k] - box_.low[k]) / edge_[k]));
    return around(key);
  }
  CellKey around(CellKey key) const {
    for (size_t k = 0; k < 3; ++k)
      if (count_[k] > 0) key[k] = ((key[k] % count_[k]) + count_[k]) % count_[k];
    return key;
  }
  /// All cells about one and itself, each once: of few periodic cells several are the same.
  std::vector<CellKey> neighbours(const CellKey& key) const {
    std::vector<CellKey> out;
    for (int64_t i = -1; i <= 1; ++i)
      for (int64_t j = -1; j <= 1; ++j)
        for (int64_t k = -1; k <= 1; ++k)
          out.push_back(around({key[0] + i, key[1] + j, key[2] + k}));
    std::ranges::sort(out);
    const auto twice = std::ranges::unique(out);
    out.erase(twice.begin(), twice.end());
    return out;
  }
  std::pair<size_t, size_t> cell(const CellKey& key) const {
    const auto [first, last] = std::ranges::equal_range(members_, key, {}, &Member::key);
    return {size_t(first - members_.begin()), size_t(last - members_.begin())};
  }

  std::span<const Vec3> points_;
  PeriodicBox box_;
  std::array<int64_t, 3> count_{};  ///< of cells along periodic axes; 0 along others
  Vec3 edge_;                       ///< [m]
  std::vector<Member> members_;
};

double ball_volume(double radius) {
  return 4.0 / 3 * det::pi * radius * radius * radius;
}

}  // namespace

std::vector<double> radial_distribution(std::span<const Vec3> points, const PeriodicBox& box,
                                        double range, size_t shells) {
  std::vector<double> out(shells, 0.0);
  if (points.size() < 2 || shells == 0) return out;
  uint64_t pairs = 0;
  const double per_metre = double(shells) / range;
  RadialCells(points, box, range).for_pairs([&](double square) {
    if (!(square < range * range)) return;
    out[std::min(size_t(std::sqrt(square) * per_metre), shells - 1)] += 1;
    ++pairs;
  });
  const auto n = double(points.size());
  const bool closed = (box.size.array() > 0).all();
  // Pairs that are to be expected in a unit of volume about a point.
  const double density =
      closed ? 0.5 * n * (n - 1) / box.size.prod() : double(pairs) / ball_volume(range);
  for (size_t k = 0; k < shells && density > 0; ++k)
    out[k] /=
        density * (ball_volume(double(k + 1) / per_metre) - ball_volume(double(k) / per_metre));
  return out;
}

}  // namespace tumble
