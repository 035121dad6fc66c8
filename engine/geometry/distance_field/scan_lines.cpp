#include "engine/geometry/distance_field/scan_lines.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/stop.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

struct NodeSpan {
  int first, last;
};

/// The nodes of an axis within an interval, with one more on either side for rounding.
NodeSpan nodes_about(const FieldLayout& layout, int axis, double low, double high) {
  const int most = FieldLayout::cells_along * layout.blocks[size_t(axis)];
  const double from = std::floor((low - layout.origin[axis]) / layout.cell) - 1,
               to = std::ceil((high - layout.origin[axis]) / layout.cell) + 1;
  return {int(std::clamp(from, 0.0, double(most))), int(std::clamp(to, 0.0, double(most)))};
}

/// Appends the crossings of grid rows with one triangle.
void cross_rows(const TriangleMesh& mesh, size_t t, const FieldLayout& layout,
                std::vector<RowCrossing>& out) {
  const Triangle3 corners{mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
  const Aabb box = triangle_bounds(mesh, t);
  const NodeSpan ys = nodes_about(layout, 1, box.min.y(), box.max.y()),
                 zs = nodes_about(layout, 2, box.min.z(), box.max.z()),
                 xs = nodes_about(layout, 0, box.min.x(), box.max.x());
  const int rows = FieldLayout::cells_along * layout.blocks[1] + 1;
  for (int z = zs.first; z <= zs.last; ++z)
    for (int y = ys.first; y <= ys.last; ++y) {
      const double py = layout.at(1, y), pz = layout.at(2, z);
      if (py < box.min.y() || py > box.max.y() || pz < box.min.z() || pz > box.max.z()) continue;
      const Vec3 before(box.min.x() - layout.cell, py, pz);
      const int turns = ray_crossing(before, corners);
      if (turns == 0) continue;
      // Finds the first node after the crossing by bisection.
      int low = xs.first, high = xs.last + 1;
      while (low < high) {
        const int middle = low + (high - low) / 2;
        if (ray_crossing(layout.node(middle, y, z), corners) != 0) {
          low = middle + 1;
        } else {
          high = middle;
        }
      }
      out.push_back({uint32_t(z * rows + y), low, turns});
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
