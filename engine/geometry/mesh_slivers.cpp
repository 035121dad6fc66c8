#include "engine/geometry/mesh_slivers.hpp"

#include "engine/geometry/mesh_sides.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>
#include <unordered_map>

namespace tumble {
namespace {

/// Heights below this share of the longest side are rounding errors [-].
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

/// The edges with their triangles, updated as triangles are flipped.
class Edges {
 public:
  explicit Edges(const TriangleMesh& mesh) {
    edges_.reserve(mesh.triangles.size() * 3 / 2);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) add_triangle(mesh.triangles[t], t);
  }
  void add_triangle(const Triangle& c, uint32_t t) {
    for (size_t k = 0; k < 3; ++k) {
      Faces& f = edges_[key(c[k], c[(k + 1) % 3])];
      if (f.count < 2) f.face[f.count] = t;
      ++f.count;
    }
  }

  /// The triangle on the other side of an edge of t; no_index if the edge does not have exactly
  /// two.
  uint32_t across(uint32_t a, uint32_t b, uint32_t t) const {
    const Faces& f = edges_.at(key(a, b));
    return f.count != 2 ? no_index : f.face[0] == t ? f.face[1] : f.face[0];
  }
  /// Whether the mesh has, or had, this edge.
  bool known(uint32_t a, uint32_t b) const { return edges_.contains(key(a, b)); }
  /// Whether another triangle may use this edge.
  bool free(uint32_t a, uint32_t b) const {
    const auto at = edges_.find(key(a, b));
    return at == edges_.end() || at->second.count < 2;
  }
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
    std::array<uint32_t, 2> face{no_index, no_index};  // the first two triangles
    uint32_t count = 0;
  };
  static uint64_t key(uint32_t a, uint32_t b) {
    return uint64_t(std::min(a, b)) << 32 | std::max(a, b);
  }
  // Only for look-ups; never iterated, since the order is unspecified.
  std::unordered_map<uint64_t, Faces> edges_;
};

/// Splits slivers in the order in which that becomes possible.
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
    size_t at = 0;  // index of the corner where side a-b of the neighbour starts
    while (whole[(at + 2) % 3] == a || whole[(at + 2) % 3] == b) ++at;
    const uint32_t p = whole[at], q = whole[(at + 1) % 3], r = whole[(at + 2) % 3];
    // A removed edge is never added again: no flip is undone, so the process terminates.
    if (r == m || edges_.known(m, r)) return false;
    mesh_.triangles[n] = {p, m, r};
    mesh_.triangles[t] = {m, q, r};
    edges_.add(m, r, t, n);
    edges_.hand_over(p, m, t, n);
    edges_.hand_over(q, r, n, t);
    // Slivers that could not be split because of a neighbouring sliver may be now.
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
  std::queue<uint32_t> waiting_;  // triangles to be examined
};

/// k-d tree of vertices: the median of each range, along one axis after the other, divides it.
class VertexTree {
 public:
  VertexTree(const std::vector<Vec3>& places, std::vector<uint32_t> vertices)
      : places_(places), order_(std::move(vertices)) {
    part(0, order_.size(), 0);
  }

  /// Calls found(v) for every vertex within `reach` [m] of the segment a-b, and possibly for
  /// others.
  template <class Found>
  void near_segment(const Vec3& a, const Vec3& b, double reach, const Found& found) const {
    search({a, b - a, reach}, 0, order_.size(), 0, 0, 1, found);
  }

 private:
  struct Segment {
    Vec3 start, along;
    double reach;
  };

  void part(size_t begin, size_t end, int axis) {
    if (end - begin < 2) return;
    const size_t middle = begin + (end - begin) / 2;
    const auto at = [&](size_t i) { return order_.begin() + std::ptrdiff_t(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](uint32_t i, uint32_t j) {
      const double x = places_[i][axis], y = places_[j][axis];
      return x != y ? x < y : i < j;
    });
    part(begin, middle, (axis + 1) % 3);
    part(middle + 1, end, (axis + 1) % 3);
  }

  /// Searches a range; only the part t0 to t1 of the segment can be near its vertices.
  template <class Found>
  void search(const Segment& s, size_t begin, size_t end, int axis, double t0, double t1,
              const Found& found) const {
    if (begin == end || !(t0 <= t1)) return;
    const size_t middle = begin + (end - begin) / 2;
    found(order_[middle]);
    for (const int side : {-1, 1}) {
      // The part on this side of the plane, or within reach of it: side * (start + t along - plane)
      // >= -r.
      const double slope = side * s.along[axis];
      const double offset = side * (s.start[axis] - places_[order_[middle]][axis]) + s.reach;
      double from = t0, to = t1;
      if (slope > 0) from = std::max(from, -offset / slope);
      if (slope < 0) to = std::min(to, -offset / slope);
      if (slope == 0 && offset < 0) continue;
      search(s, side < 0 ? begin : middle + 1, side < 0 ? middle : end, (axis + 1) % 3, from, to,
             found);
    }
  }

  const std::vector<Vec3>& places_;
  std::vector<uint32_t> order_;
};

/// The open edges and their vertices.
struct Boundary {
  std::vector<MeshSide> sides;
  std::vector<uint32_t> vertices;
};

Boundary boundary_of(const TriangleMesh& mesh) {
  Boundary out;
  const std::vector<MeshSide> sides = sorted_sides(mesh);
  const auto same = [&](size_t i, size_t j) {
    return j < sides.size() && sides[i].low == sides[j].low && sides[i].high == sides[j].high;
  };
  for (size_t i = 0; i < sides.size(); ++i) {
    if (same(i, i - 1) || same(i, i + 1)) continue;
    out.sides.push_back(sides[i]);
    out.vertices.insert(out.vertices.end(), {sides[i].low, sides[i].high});
  }
  std::sort(out.vertices.begin(), out.vertices.end());
  out.vertices.erase(std::unique(out.vertices.begin(), out.vertices.end()), out.vertices.end());
  return out;
}

/// The vertices that lie on a side of a triangle, in order from its start to its end.
std::vector<uint32_t> vertices_on_side(const TriangleMesh& mesh, const MeshSide& side,
                                       const VertexTree& tree, double height) {
  const Triangle& t = mesh.triangles[side.face];
  const uint32_t a = t[side.k], b = t[(side.k + 1u) % 3], c = t[(side.k + 2u) % 3];
  const Vec3 start = mesh.vertices[a], along = mesh.vertices[b] - start;
  std::vector<std::pair<double, uint32_t>> found;
  // Twice the needed distance, so that rounding in the tree loses none.
  const double reach = 2 * std::max(height, rounding * (start.norm() + along.norm()));
  tree.near_segment(start, mesh.vertices[b], reach, [&](uint32_t m) {
    if (m == a || m == b || m == c) return;
    const Triangle sliver{b, a, m};
    const double s = (mesh.vertices[m] - start).dot(along) / along.squaredNorm();
    if (s > 0 && s < 1 && is_sliver(mesh, sliver, height) && longest_side(mesh, sliver).corner == 0)
      found.push_back({s, m});
  });
  std::sort(found.begin(), found.end());
  std::vector<uint32_t> out;
  for (const auto& [s, m] : found) out.push_back(m);
  return out;
}

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

std::vector<uint32_t> close_t_junctions(TriangleMesh& mesh, double height) {
  std::vector<uint32_t> beside;
  const Boundary open = boundary_of(mesh);
  if (open.sides.empty()) return beside;
  const VertexTree tree(mesh.vertices, open.vertices);
  std::optional<Edges> edges;
  for (const MeshSide& side : open.sides) {
    const std::vector<uint32_t> on = vertices_on_side(mesh, side, tree, height);
    if (on.empty()) continue;
    if (!edges) edges.emplace(mesh);
    const Triangle whole = mesh.triangles[side.face];
    const uint32_t b = whole[(side.k + 1u) % 3], c = whole[(side.k + 2u) % 3];
    uint32_t from = whole[side.k];
    bool free = edges->free(on.back(), b);
    for (const uint32_t m : on) {
      free = free && edges->free(from, m) && !edges->known(m, c) &&
             (m == on.back() || !edges->known(m, b));
      from = m;
    }
    if (!free) continue;
    from = whole[side.k];
    for (const uint32_t m : on) {
      edges->add_triangle({b, from, m}, uint32_t(mesh.triangles.size()));
      mesh.triangles.push_back({b, from, m});
      beside.push_back(side.face);
      from = m;
    }
  }
  return beside;
}

size_t split_at_slivers(TriangleMesh& mesh, double height) {
  const auto sliver = [&](const Triangle& t) { return is_sliver(mesh, t, height); };
  if (std::none_of(mesh.triangles.begin(), mesh.triangles.end(), sliver)) return 0;
  return Splitter(mesh, height).run();
}

}  // namespace tumble
