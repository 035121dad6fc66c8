#include "engine/geometry/mesh_sides.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Stable sort by the higher vertex.
void sort_around_vertex(MeshSide* first, MeshSide* last) {
  constexpr auto less = [](const MeshSide& a, const MeshSide& b) { return a.high < b.high; };
  if (last - first > 32) {
    std::stable_sort(first, last, less);
    return;
  }
  for (MeshSide* s = first; s != last; ++s) {
    const MeshSide side = *s;
    MeshSide* at = s;
    for (; at != first && less(side, at[-1]); --at) *at = at[-1];
    *at = side;
  }
}

}  // namespace

std::vector<MeshSide> sorted_sides(const TriangleMesh& mesh) {
  // Counting sort by the lower vertex, in the order of faces.
  std::vector<uint32_t> first(mesh.vertices.size() + 1, 0);
  for (const Triangle& t : mesh.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a != b) ++first[std::min(a, b) + 1];
    }
  }
  for (size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
  std::vector<MeshSide> sides(first.back());
  std::vector<uint32_t> next(first.begin(), first.end() - 1);
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    for (uint8_t k = 0; k < 3; ++k) {
      const uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
      if (a != b) sides[next[std::min(a, b)]++] = {std::min(a, b), std::max(a, b), f, k, a < b};
    }
  }
  for (size_t v = 0; v + 1 < first.size(); ++v) {
    sort_around_vertex(sides.data() + first[v], sides.data() + first[v + 1]);
  }
  return sides;
}

EdgeFaults edge_faults(const TriangleMesh& mesh) {
  EdgeFaults out;
  const std::vector<MeshSide> sides = sorted_sides(mesh);
  for (size_t i = 0, end = 0; i < sides.size(); i = end) {
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high)
      ++end;
    out.open += end - i == 1;
    out.non_manifold += end - i > 2;
    out.misoriented += end - i == 2 && sides[i].forward == sides[i + 1].forward;
  }
  return out;
}

}  // namespace tumble
