#include "engine/geometry/mesh_slivers.hpp"

#include "engine/geometry/mesh_sides.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace tumble {
namespace {

/// Slivers of one fan are split one after the other, a pass each; hostile files have no fan longer
/// than this.
constexpr int most_passes = 100;
/// Heights below this part of the longest side are rounding error [-].
constexpr double rounding = 1e-15;

/// The corner from which a triangle's longest side starts.
size_t longest_side(const TriangleMesh& mesh, const Triangle& t, double& squared) {
  size_t longest = 0;
  squared = -1;
  for (size_t k = 0; k < 3; ++k) {
    const double s = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm();
    if (s > squared) {
      squared = s;
      longest = k;
    }
  }
  return longest;
}

/// One pass over all triangles.
class Splitter {
 public:
  Splitter(TriangleMesh& mesh, double height)
      : mesh_(mesh), height_(height), sides_(sorted_sides(mesh)), done_(mesh.triangles.size(), 0) {}

  size_t run() {
    size_t count = 0;
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) count += split_at(t);
    return count;
  }

 private:
  using Edge = std::pair<uint32_t, uint32_t>;
  static Edge edge(uint32_t a, uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

  bool sliver(uint32_t t) const {
    const Triangle& c = mesh_.triangles[t];
    double squared = 0;
    longest_side(mesh_, c, squared);
    return triangle_height(mesh_, c) <= std::max(height_, rounding * std::sqrt(squared));
  }

  auto sides_of(Edge e) const {
    return std::equal_range(sides_.begin(), sides_.end(), MeshSide{e.first, e.second, 0, 0, false},
                            [](const MeshSide& a, const MeshSide& b) {
                              return a.low != b.low ? a.low < b.low : a.high < b.high;
                            });
  }

  bool split_at(uint32_t t) {
    const Triangle c = mesh_.triangles[t];
    if (done_[t] || c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || !sliver(t)) return false;
    double squared = 0;
    const size_t k = longest_side(mesh_, c, squared);
    const uint32_t m = c[(k + 2) % 3];
    const auto [first, last] = sides_of(edge(c[k], c[(k + 1) % 3]));
    if (last - first != 2) return false;
    const MeshSide& across = first->face == t ? first[1] : first[0];
    const uint32_t n = across.face;
    if (n == t || done_[n] || sliver(n)) return false;
    const Triangle whole = mesh_.triangles[n];
    const uint32_t p = whole[across.k], q = whole[(across.k + 1u) % 3],
                   r = whole[(across.k + 2u) % 3];
    const auto [old_first, old_last] = sides_of(edge(m, r));
    if (r == m || old_first != old_last || !added_.insert(edge(m, r)).second) return false;
    mesh_.triangles[n] = {p, m, r};
    mesh_.triangles[t] = {m, q, r};
    done_[t] = done_[n] = 1;
    return true;
  }

  TriangleMesh& mesh_;
  double height_;
  std::vector<MeshSide> sides_;  // before the pass
  std::set<Edge> added_;
  std::vector<uint8_t> done_;
};

}  // namespace

double triangle_height(const TriangleMesh& mesh, const Triangle& t) {
  double squared = 0;
  longest_side(mesh, t, squared);
  if (!(squared > 0)) return 0;
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a).norm() / std::sqrt(squared);
}

size_t split_at_slivers(TriangleMesh& mesh, double height) {
  size_t count = 0;
  const auto thin = [&](const Triangle& t) {
    double squared = 0;
    longest_side(mesh, t, squared);
    return triangle_height(mesh, t) <= std::max(height, rounding * std::sqrt(squared));
  };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), thin)) return 0;
  for (int pass = 0; pass < most_passes; ++pass) {
    const size_t split = Splitter(mesh, height).run();
    if (split == 0) break;
    count += split;
  }
  return count;
}

}  // namespace tumble
