#include "engine/geometry/hierarchy/level.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// A bright colour with the hue 0..1.
Vec4f hue_colour(double hue) {
  const auto part = [hue](double shift) {
    const double h = hue + shift - std::floor(hue + shift);
    return float(std::clamp(std::fabs(6 * h - 3) - 1, 0.0, 1.0));
  };
  // Mixed with white, so that no hue looks much darker than the others.
  const Vec4f pure(part(0), part(2.0 / 3), part(1.0 / 3), 1);
  return Vec4f(0.12f, 0.12f, 0.12f, 0) + Vec4f(0.88f, 0.88f, 0.88f, 1).cwiseProduct(pure);
}

}  // namespace

std::vector<NodeBound> level_bounds(const Hierarchy& hierarchy, int level) {
  std::vector<NodeBound> out;
  hierarchy.visit_nodes([&](const NodeBound& bound) {
    if (bound.level < level && !bound.leaf) return true;
    out.push_back(bound);
    return false;
  });
  return out;
}

Vec4f node_colour(const Hierarchy& hierarchy, const NodeBound& bound) {
  const auto order = hierarchy.triangle_order();
  if (order.empty()) return hue_colour(0);
  const double first = double(bound.triangles.data() - order.data());
  return hue_colour((first + 0.5 * double(bound.triangles.size())) / double(order.size()));
}

void draw_level(const Hierarchy& hierarchy, int level, const Pose& pose, DebugDraw& out) {
  for (const NodeBound& bound : level_bounds(hierarchy, level))
    draw_bound(bound, pose, node_colour(hierarchy, bound), out);
}

HierarchyRoom measure_room(const Hierarchy& hierarchy) {
  HierarchyRoom room;
  double sum = 0;
  hierarchy.visit_nodes([&](const NodeBound& bound) {
    const ConvexMeasure m = measure(bound);
    ++room.nodes;
    sum += m.surface;
    if (bound.level == 0) {
      room.root_volume = m.volume;
      room.root_surface = m.surface;
    }
    if (bound.leaf) {
      ++room.leaves;
      room.leaf_volume += m.volume;
      room.leaf_surface += m.surface;
    }
    return true;
  });
  room.nodes_per_line = room.root_surface > 0 ? sum / room.root_surface : double(room.nodes);
  return room;
}

}  // namespace tumble
