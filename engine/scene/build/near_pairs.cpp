#include "engine/scene/build/near_pairs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// Index of a cell along each axis: integers that a double represents exactly.
using Cell = std::array<double, 3>;

struct Placed {
  Cell cell;
  uint32_t point;
};

/// Edge of the cells [m]: slightly more than the reach, so that rounding never puts two near points
/// two cells apart, and not smaller than indices in double precision allow.
double cell_edge(std::span<const Vec3> points, double reach) {
  double extent = 0;
  for (const Vec3& x : points) extent = std::max(extent, x.cwiseAbs().maxCoeff());
  return std::max(1.001 * reach, 0x1p-40 * extent);
}

/// The points in the order of their cells.
std::vector<Placed> sorted_into_cells(std::span<const Vec3> points, double edge) {
  std::vector<Placed> out;
  out.reserve(points.size());
  for (uint32_t i = 0; i < points.size(); ++i) {
    const Vec3 c = points[i] / edge;
    out.push_back({{std::floor(c.x()), std::floor(c.y()), std::floor(c.z())}, i});
  }
  std::sort(out.begin(), out.end(), [](const Placed& a, const Placed& b) {
    return std::pair(a.cell, a.point) < std::pair(b.cell, b.point);
  });
  return out;
}

}  // namespace

std::optional<std::vector<std::pair<uint32_t, uint32_t>>> near_pairs(std::span<const Vec3> points,
                                                                     double reach, size_t most) {
  const double edge = cell_edge(points, reach), furthest = reach * (1 + 1e-9);
  const std::vector<Placed> placed = sorted_into_cells(points, edge);
  std::vector<std::pair<uint32_t, uint32_t>> out;
  // Each point is compared with those after it in its own cell, and with half of the cells around:
  // three neighbouring cells along the last axis are contiguous in the sorted list. In a crowded
  // cell a fixed share of the tested pairs are near, so that the limit is reached before many were
  // tested.
  constexpr std::array<std::array<double, 2>, 4> rows{{{0, 1}, {1, -1}, {1, 0}, {1, 1}}};
  const auto try_run = [&](const Placed& a, std::vector<Placed>::const_iterator run,
                           const Cell& last) {
    for (; run != placed.end() && run->cell <= last; ++run) {
      if (!((points[a.point] - points[run->point]).squaredNorm() <= furthest * furthest)) continue;
      if (out.size() == most) return false;
      out.emplace_back(std::min(a.point, run->point), std::max(a.point, run->point));
    }
    return true;
  };
  for (auto a = placed.begin(); a != placed.end(); ++a) {
    const auto& [x, y, z] = a->cell;
    if (!try_run(*a, a + 1, {x, y, z + 1})) return std::nullopt;
    for (const auto& [dx, dy] : rows) {
      const Cell first{x + dx, y + dy, z - 1};
      const auto run = std::lower_bound(placed.begin(), placed.end(), first,
                                        [](const Placed& p, const Cell& c) { return p.cell < c; });
      if (!try_run(*a, run, {x + dx, y + dy, z + 1})) return std::nullopt;
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace tumble
