#include "engine/collision/broad_phase/draw_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {

Vec4f level_colour(size_t level) {
  constexpr std::array<std::array<float, 3>, 8> colours{{{1.0f, 0.25f, 0.15f},
                                                         {1.0f, 0.65f, 0.1f},
                                                         {0.85f, 0.95f, 0.2f},
                                                         {0.2f, 0.9f, 0.35f},
                                                         {0.1f, 0.85f, 0.95f},
                                                         {0.25f, 0.5f, 1.0f},
                                                         {0.65f, 0.35f, 1.0f},
                                                         {1.0f, 0.35f, 0.75f}}};
  const auto& c = colours[level % colours.size()];
  return {c[0], c[1], c[2], 0.9f};
}

void draw_cells(std::span<const BroadPhaseProxy> proxies, std::span<const uint32_t> ids,
                double edge, const Vec4f& colour, DebugDraw& out) {
  std::vector<std::array<double, 3>> cells;
  for (const uint32_t id : ids) {
    const Vec3 lo = (proxies[id].bounds.min / edge).array().floor();
    const Vec3 hi = (proxies[id].bounds.max / edge).array().floor();
    // Two cells along each axis at most: no member is larger than a cell.
    for (int k = 0; k < 8; ++k) {
      const std::array<double, 3> cell{k & 1 ? hi.x() : lo.x(), k & 2 ? hi.y() : lo.y(),
                                       k & 4 ? hi.z() : lo.z()};
      cells.push_back(cell);
    }
  }
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  for (const auto& c : cells) {
    const Vec3 corner = edge * Vec3(c[0], c[1], c[2]);
    draw_box(out, corner, corner.array() + edge, colour);
  }
}

}  // namespace tumble
