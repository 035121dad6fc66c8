#include "engine/geometry/distance_field/scan_lines.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// The nodes of an axis from `first` to before `end`.
struct NodeSpan {
  int first, end;
};

/// The nodes of an axis within an interval.
NodeSpan nodes_within(const FieldLayout& layout, int axis, double low, double high) {
  const int count = FieldLayout::cells_along * layout.blocks[size_t(axis)] + 1;
  const auto guess = [&](double x) {
    return int(std::clamp(std::ceil((x - layout.origin[axis]) / layout.cell), 0.0, double(count)));
  };
  NodeSpan out{guess(low), guess(high)};
  while (out.first > 0 && layout.at(axis, out.first - 1) >= low) --out.first;
  while (out.first < count && layout.at(axis, out.first) < low) ++out.first;
  while (out.end > 0 && layout.at(axis, out.end - 1) > high) --out.end;
  while (out.end < count && layout.at(axis, out.end) <= high) ++out.end;
  return out;
}

/// Appends the crossings of grid rows with one triangle.
void cross_rows(const TriangleMesh& mesh, size_t t, const FieldLayout& layout,
                std::vector<RowCrossing>& out) {
  const Triangle3 corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
  const Aabb box = triangle_bounds(mesh, t);
  const NodeSpan ys = nodes_within(layout, 1, box.min.y(), box.max.y()),
                 zs = nodes_within(layout, 2, box.min.z(), box.max.z());
  if (ys.first >= ys.end || zs.first >= zs.end) return;
  const NodeSpan xs = nodes_within(layout, 0, box.min.x(), box.max.x());
  const int rows = FieldLayout::cells_along * layout.blocks[1] + 1;
  const Vec3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  for (int z = zs.first; z < zs.end; ++z)
    for (int y = ys.first; y < ys.end; ++y) {
      const Vec2 p(layout.at(1, y), layout.at(2, z));
      const int turns = line_crossing(p, corners);
      if (turns == 0) continue;
      // The first node after the crossing is sought from where doubles have the plane, which is
      // nearly always next to it, and decided exactly.
      const auto before = [&](int x) {
        return orientation(corners[0], corners[1], corners[2], layout.node(x, y, z)) == -turns;
      };
      const double plane = corners[0].x() - (normal.y() * (p.x() - corners[0].y()) +
                                             normal.z() * (p.y() - corners[0].z())) /
                                                normal.x();
      const double guess = std::ceil((plane - layout.origin.x()) / layout.cell);
      int node = guess >= xs.first && guess < xs.end ? int(guess) : xs.end;
      while (node > xs.first && !before(node - 1)) --node;
      while (node < xs.end && before(node)) ++node;
      out.push_back({uint32_t(z * rows + y), node, turns});
    }
}

}  // namespace

ScanLines::ScanLines(const TriangleMesh& mesh, const FieldLayout& layout, Crew* crew)
    : rows_along_y_(size_t(FieldLayout::cells_along * layout.blocks[1] + 1)) {
  const size_t rows = rows_along_y_ * size_t(FieldLayout::cells_along * layout.blocks[2] + 1);
  std::vector<std::vector<RowCrossing>> found(chunk_count);
  for_chunks(crew, mesh.triangles.size(), [&](size_t chunk, size_t first, size_t last) {
    for (size_t t = first; t < last && !stop_requested(); ++t)
      cross_rows(mesh, t, layout, found[chunk]);
  });
  first_.assign(rows + 1, 0);
  if (stop_requested()) return;
  for (const auto& part : found)
    for (const RowCrossing& c : part) ++first_[c.row + 1];
  for (size_t r = 0; r < rows; ++r) first_[r + 1] += first_[r];
  crossings_.resize(first_.back());
  std::vector<size_t> next(first_.begin(), first_.end() - 1);
  for (const auto& part : found)
    for (const RowCrossing& c : part) crossings_[next[c.row]++] = c;
  for (size_t r = 0; r < rows; ++r)
    std::sort(crossings_.begin() + std::ptrdiff_t(first_[r]),
              crossings_.begin() + std::ptrdiff_t(first_[r + 1]),
              [](const RowCrossing& a, const RowCrossing& b) {
                return a.node != b.node ? a.node < b.node : a.turns < b.turns;
              });
}

std::span<const RowCrossing> ScanLines::row(int y, int z) const {
  const size_t r = size_t(z) * rows_along_y_ + size_t(y);
  return {crossings_.data() + first_[r], first_[r + 1] - first_[r]};
}

void ScanLines::winding(int y, int z, int first, int count, int step, int* out) const {
  const auto crossings = row(y, z);
  size_t ahead = crossings.size();
  int turns = 0;
  for (int n = count - 1; n >= 0; --n) {
    for (; ahead > 0 && crossings[ahead - 1].node > first + n * step; --ahead)
      turns += crossings[ahead - 1].turns;
    out[n] = turns;
  }
}

void ScanLines::parity(int y, int z, int first, int count, int step, bool* out) const {
  const auto crossings = row(y, z);
  size_t ahead = crossings.size();
  for (int n = count - 1; n >= 0; --n) {
    while (ahead > 0 && crossings[ahead - 1].node > first + n * step) --ahead;
    out[n] = (crossings.size() - ahead) % 2 != 0;
  }
}

}  // namespace tumble
