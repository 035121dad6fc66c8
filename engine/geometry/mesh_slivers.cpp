#include "engine/geometry/mesh_slivers.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

namespace tumble {
namespace {

/// Heights below this part of the longest side are rounding error [-].
constexpr double rounding = 1e-15;

/// The corner from which a triangle's longest side starts, and that side's squared length [m^2].
struct LongestSide {
  size_t corner = 0;
  double squared = 0;
};

LongestSide longest_side(const TriangleMesh& mesh, const Triangle& t) {
  LongestSide longest;
  for (size_t k = 0; k < 3; ++k) {
    const double s = (mesh.vertices[t[(k + 1) % 3]] - mesh.vertices[t[k]]).squaredNorm();
    if (s > longest.squared) longest = {k, s};
  }
  return longest;
}

/// The edges with their triangles, kept up to date while triangles are flipped.
class Edges {
 public:
  explicit Edges(const TriangleMesh& mesh) {
    edges_.reserve(mesh.triangles.size() * 3 / 2);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const Triangle& c = mesh.triangles[t];
      for (size_t k = 0; k < 3; ++k) {
        Faces& f = edges_[key(c[k], c[(k + 1) % 3])];
        if (f.count < 2) f.face[f.count] = t;
        ++f.count;
      }
    }
  }

  /// The triangle on the other side of an edge of t; no_index where it has not exactly two.
  uint32_t across(uint32_t a, uint32_t b, uint32_t t) const {
    const Faces& f = edges_.at(key(a, b));
    return f.count != 2 ? no_index : f.face[0] == t ? f.face[1] : f.face[0];
  }
  /// Whether the mesh has, or had, this edge.
  bool known(uint32_t a, uint32_t b) const { return edges_.contains(key(a, b)); }
  void add(uint32_t a, uint32_t b, uint32_t first, uint32_t second) {
    edges_[key(a, b)] = {{first, second}, 2};
  }
  void hand_over(uint32_t a, uint32_t b, uint32_t from, uint32_t to) {
    Faces& f = edges_.at(key(a, b));
    for (uint32_t& face : f.face) {
      if (face == from) {
        face = to;
        return;
      }
    }
  }

 private:
  struct Faces {
    std::array<uint32_t, 2> face{no_index, no_index};  // the first two
    uint32_t count = 0;
  };
  static uint64_t key(uint32_t a, uint32_t b) {
    return uint64_t(std::min(a, b)) << 32 | std::max(a, b);
  }
  std::unordered_map<uint64_t, Faces> edges_;  // looked up, never walked
};

/// Splits one sliver after the other, in the order in which they become possible.
class Splitter {
 public:
  Splitter(TriangleMesh& mesh, double height) : mesh_(mesh), height_(height), edges_(mesh) {
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) waiting_.push(t);
  }

  size_t run() {
    size_t count = 0;
    for (; !waiting_.empty(); waiting_.pop()) count += split_at(waiting_.front());
    return count;
  }

 private:
  bool split_at(uint32_t t) {
    const Triangle c = mesh_.triangles[t];
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0] || !is_sliver(mesh_, c, height_)) return false;
    const size_t k = longest_side(mesh_, c).corner;
    const uint32_t a = c[k], b = c[(k + 1) % 3], m = c[(k + 2) % 3];
    const uint32_t n = edges_.across(a, b, t);
    if (n == no_index || n == t || is_sliver(mesh_, mesh_.triangles[n], height_)) return false;
    const Triangle whole = mesh_.triangles[n];
    size_t at = 0;  // of the corner from which the whole triangle's side a-b starts
    while (whole[(at + 2) % 3] == a || whole[(at + 2) % 3] == b) ++at;
    const uint32_t p = whole[at], q = whole[(at + 1) % 3], r = whole[(at + 2) % 3];
    // An edge that went does not come back: no flip is undone, so that the work ends.
    if (r == m || edges_.known(m, r)) return false;
    mesh_.triangles[n] = {p, m, r};
    mesh_.triangles[t] = {m, q, r};
    edges_.add(m, r, t, n);
    edges_.hand_over(p, m, t, n);
    edges_.hand_over(q, r, n, t);
    // What could not be split because its neighbour was a sliver may be now.
    for (const uint32_t changed : {t, n}) {
      waiting_.push(changed);
      const Triangle& sides = mesh_.triangles[changed];
      for (size_t i = 0; i < 3; ++i) {
        const uint32_t next = edges_.across(sides[i], sides[(i + 1) % 3], changed);
        if (next != no_index) waiting_.push(next);
      }
    }
    return true;
  }

  TriangleMesh& mesh_;
  double height_;
  Edges edges_;
  std::queue<uint32_t> waiting_;  // triangles to look at
};

}  // namespace

double triangle_height(const TriangleMesh& mesh, const Triangle& t) {
  const double squared = longest_side(mesh, t).squared;
  if (!(squared > 0)) return 0;
  const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
  return (b - a).cross(c - a).norm() / std::sqrt(squared);
}

bool is_sliver(const TriangleMesh& mesh, const Triangle& t, double height) {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return true;
  const double longest = std::sqrt(longest_side(mesh, t).squared);
  return !(triangle_height(mesh, t) > std::max(height, rounding * longest));
}

size_t split_at_slivers(TriangleMesh& mesh, double height) {
  const auto sliver = [&](const Triangle& t) { return is_sliver(mesh, t, height); };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), sliver)) return 0;
  return Splitter(mesh, height).run();
}

}  // namespace tumble
