#include "engine/dynamics/particles/radial_distribution.hpp"

#include "engine/core/stop.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tumble {
namespace {

using CellKey = std::array<int64_t, 3>;

/// The whole number below, no farther from 0 than cells can be told apart.
int64_t whole_cell(double x) {
  constexpr double most = tolerances::most_cells;
  return int64_t(std::max(-most, std::min(most, std::floor(x))));
}

/// Points by the cells of a grid of at least `range`; along periodic axes the last cell is next to
/// the first.
class RadialCells {
 public:
  RadialCells(std::span<const Vec3> points, const PeriodicBox& box, double range) : box_(box) {
    for (int k = 0; k < 3; ++k) {
      count_[size_t(k)] = box.along(k) ? std::max<int64_t>(1, whole_cell(box.size[k] / range)) : 0;
      edge_[k] = box.along(k) ? box.size[k] / double(count_[size_t(k)]) : range;
    }
    members_.reserve(points.size());
    places_.reserve(points.size());
    for (uint32_t i = 0; i < points.size(); ++i) members_.push_back({key_of(points[i]), i});
    std::ranges::sort(members_);
    for (const Member& m : members_) places_.push_back(points[m.index]);
  }

  /// From every how manieth point distances are taken, so that there are about `most` pairs. It is
  /// odd: kinds of points that take turns are all among these points.
  size_t stride_for(double most) const {
    const size_t n = members_.size(), step = std::max<size_t>(1, n / tolerances::radial_samples);
    double work = 0, samples = 0;
    for (size_t i = 0; i < n && !stop_requested(); i += step, ++samples) {
      const auto [first, last] = cell(members_[i].key);
      const std::vector<Range> near = neighbours(members_[i].key);
      for (const auto& [from, to] : near) work += double(to - from);
      work += tolerances::radial_lookup * double(near.size()) / double(last - first);
    }
    const double all = double(n) * work / std::max(1.0, samples);
    // From all points each pair is looked at once, from few of them from both ends.
    return 0.5 * all <= most ? 1 : size_t(std::ceil(std::min(all / most, double(n)))) | 1;
  }

  /// Calls f(squared distance) for every pair of points in neighbouring cells: with a stride of 1
  /// once, else once for each end whose index is a multiple of the stride.
  template <class F>
  void for_pairs(size_t stride, const F& f) const {
    const auto is_centre = [&](const Member& m) { return m.index % stride == 0; };
    for (size_t begin = 0, end = 0; begin < members_.size(); begin = end) {
      const CellKey& key = members_[begin].key;
      bool any = false;
      for (end = begin; end < members_.size() && members_[end].key == key; ++end)
        any = any || is_centre(members_[end]);
      if (!any) continue;
      const std::vector<Range> near = neighbours(key);
      for (size_t a = begin; a < end; ++a) {
        if (!is_centre(members_[a])) continue;
        if (stop_requested()) return;
        for (const auto& [from, to] : near)
          for (size_t b = stride == 1 ? std::max(from, a + 1) : from; b < to; ++b)
            if (b != a) f(box_.shortest(places_[b] - places_[a]).squaredNorm());
      }
    }
  }

 private:
  struct Member {
    CellKey key;
    uint32_t index;
    auto operator<=>(const Member&) const = default;
  };
  using Range = std::pair<size_t, size_t>;  ///< of members

  CellKey key_of(const Vec3& x) const {
    CellKey key{};
    for (int k = 0; k < 3; ++k) key[size_t(k)] = whole_cell((x[k] - box_.low[k]) / edge_[k]);
    return around(key);
  }
  CellKey around(CellKey key) const {
    for (size_t k = 0; k < 3; ++k)
      if (count_[k] > 0) key[k] = ((key[k] % count_[k]) + count_[k]) % count_[k];
    return key;
  }
  /// The members of all cells about one and itself, each once: of few periodic cells several are
  /// the same.
  std::vector<Range> neighbours(const CellKey& key) const {
    std::vector<CellKey> keys;
    for (int64_t i = -1; i <= 1; ++i)
      for (int64_t j = -1; j <= 1; ++j)
        for (int64_t k = -1; k <= 1; ++k)
          keys.push_back(around({key[0] + i, key[1] + j, key[2] + k}));
    std::ranges::sort(keys);
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<Range> out;
    for (const CellKey& near : keys) out.push_back(cell(near));
    return out;
  }
  Range cell(const CellKey& key) const {
    const auto first = std::ranges::lower_bound(members_, key, {}, &Member::key);
    const auto last = std::ranges::upper_bound(first, members_.end(), key, {}, &Member::key);
    return {size_t(first - members_.begin()), size_t(last - members_.begin())};
  }

  PeriodicBox box_;
  std::array<int64_t, 3> count_{};  ///< of cells along periodic axes; 0 along others
  Vec3 edge_;                       ///< [m]
  std::vector<Member> members_;
  std::vector<Vec3> places_;  ///< by member [m]
};

double ball_volume(double radius) {
  return 4.0 / 3 * det::pi * radius * radius * radius;
}

}  // namespace

std::vector<double> radial_distribution(std::span<const Vec3> points, const PeriodicBox& box,
                                        double range, size_t shells, double most_pairs) {
  std::vector<double> out(shells, 0.0);
  if (points.size() < 2 || shells == 0) return out;
  const RadialCells cells(points, box, range);
  const size_t stride = cells.stride_for(most_pairs);
  const double ends = stride == 1 ? 2 : 1;  // of a pair, from which it is looked at, together
  double pairs = 0;
  const double per_metre = double(shells) / range;
  cells.for_pairs(stride, [&](double square) {
    if (!(square < range * range)) return;
    out[std::min(size_t(std::sqrt(square) * per_metre), shells - 1)] += ends;
    pairs += ends;
  });
  const auto n = double(points.size()), centres = double((points.size() - 1) / stride + 1);
  const bool closed = (box.size.array() > 0).all();
  // Neighbours that are to be expected in a unit of volume, about all centres together.
  const double density = closed ? centres * (n - 1) / box.size.prod() : pairs / ball_volume(range);
  for (size_t k = 0; k < shells && density > 0; ++k) {
    const double expected =
        density * (ball_volume(double(k + 1) / per_metre) - ball_volume(double(k) / per_metre));
    out[k] = expected > 0 ? out[k] / expected : 0;  // a volume may be too small for a number
  }
  return out;
}

}  // namespace tumble
