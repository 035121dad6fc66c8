#include "engine/geometry/solid/star_arcs.hpp"

#include "engine/geometry/hierarchy/common_vertices.hpp"
#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Half-planes bounded by the line through two points, one through each apex, ordered exactly by
/// their angles about the line from the half-plane of the first apex.
class AngleOrder {
 public:
  AngleOrder(const Vec3& p, const Vec3& q, const Vec3& first) : p_(p), q_(q), first_(first) {}

  bool operator()(const Vec3& a, const Vec3& b) const {
    const int part_a = part(a), part_b = part(b);
    if (part_a != part_b) return part_a < part_b;
    return part_a % 2 == 1 && orientation(p_, q_, a, b) > 0;
  }

 private:
  /// 0: the first half-plane; 1: less than half a turn further; 2: half a turn; 3: more.
  int part(const Vec3& a) const {
    const int side = orientation(p_, q_, first_, a);
    if (side != 0) return side > 0 ? 1 : 3;
    return folded_at(p_, q_, first_, a) ? 0 : 2;
  }
  const Vec3 &p_, &q_, &first_;
};

class ArcTree {
 public:
  ArcTree(const TriangleMesh& mesh, uint32_t vertex, std::vector<StarArc>& arcs)
      : mesh_(mesh), vertex_(vertex), arcs_(arcs) {
    build(0, uint32_t(arcs.size()));
  }

  /// Calls visit(a, b) for pairs of arcs whose boxes overlap and whose triangles share no other
  /// vertex, until it returns false.
  template <class Visit>
  bool each(const Visit& visit) const {
    std::vector<TriangleIds> stack{{0, 0}};
    while (!stack.empty()) {
      const auto [i, j] = stack.back();
      stack.pop_back();
      const Node &a = nodes_[i], &b = nodes_[j];
      if (any_vertex(common_vertices(a.common, b.common))) continue;
      if (i != j && a.bound.apart(b.bound)) continue;
      if (a.leaf() && b.leaf()) {
        if (!leaves(a, b, visit)) return false;
      } else if (i == j) {
        stack.push_back({i + 1, a.second});
        stack.push_back({a.second, a.second});
        stack.push_back({i + 1, i + 1});
      } else if (b.leaf() || (!a.leaf() && a.size() >= b.size())) {
        stack.push_back({a.second, j});
        stack.push_back({i + 1, j});
      } else {
        stack.push_back({i, b.second});
        stack.push_back({i, j + 1});
      }
    }
    return true;
  }

 private:
  static constexpr uint32_t leaf_arcs = 4;

  struct Node {
    StarArc bound;
    Triangle common;  ///< other vertices common to all triangles, padded with no_index
    uint32_t first, last;
    uint32_t second = no_index;  ///< second child; the first one is the next node
    bool leaf() const { return second == no_index; }
    uint32_t size() const { return last - first; }
  };

  Triangle others(const StarArc& arc) const {
    Triangle out = mesh_.triangles[arc.triangle];
    for (uint32_t& v : out) {
      if (v == vertex_) v = no_index;
    }
    return out;
  }

  /// Splits at the median along the longest axis, so that the tree is balanced.
  void build(uint32_t first, uint32_t last) {
    const auto index = uint32_t(nodes_.size());
    Node node{arcs_[first], others(arcs_[first]), first, last};
    for (uint32_t k = first + 1; k < last; ++k) {
      node.bound.low = node.bound.low.cwiseMin(arcs_[k].low);
      node.bound.high = node.bound.high.cwiseMax(arcs_[k].high);
      node.common = common_vertices(node.common, others(arcs_[k]));
    }
    nodes_.push_back(node);
    if (last - first <= leaf_arcs) return;
    int axis = 0;
    (node.bound.high - node.bound.low).maxCoeff(&axis);
    const uint32_t middle = first + (last - first) / 2;
    std::nth_element(arcs_.begin() + first, arcs_.begin() + middle, arcs_.begin() + last,
                     [axis](const StarArc& a, const StarArc& b) {
                       const double x = a.low[axis] + a.high[axis], y = b.low[axis] + b.high[axis];
                       return x != y ? x < y : a.triangle < b.triangle;
                     });
    build(first, middle);
    nodes_[index].second = uint32_t(nodes_.size());
    build(middle, last);
  }

  template <class Visit>
  bool leaves(const Node& a, const Node& b, const Visit& visit) const {
    for (uint32_t i = a.first; i < a.last; ++i) {
      for (uint32_t j = a.first == b.first ? i + 1 : b.first; j < b.last; ++j) {
        if (arcs_[i].apart(arcs_[j])) continue;
        if (any_vertex(common_vertices(others(arcs_[i]), others(arcs_[j])))) continue;
        if (!visit(arcs_[i], arcs_[j])) return false;
      }
    }
    return true;
  }

  const TriangleMesh& mesh_;
  uint32_t vertex_;
  std::vector<StarArc>& arcs_;
  std::vector<Node> nodes_;
};

TriangleIds ascending(uint32_t a, uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// A triangle at a side of the star.
struct Page {
  uint32_t other;  ///< the side's other vertex, besides that of the star
  uint32_t apex, triangle;
};

/// Finds folded triangles among those of one side.
bool fold_pages(const TriangleMesh& mesh, uint32_t vertex, std::span<Page> pages, size_t limit,
                std::vector<TriangleIds>& out) {
  const Vec3 &p = mesh.vertices[vertex], &q = mesh.vertices[pages[0].other];
  if (pages.size() == 2 &&
      !folded_at(p, q, mesh.vertices[pages[0].apex], mesh.vertices[pages[1].apex])) {
    return true;  // nearly always
  }
  const AngleOrder less(p, q, mesh.vertices[pages[0].apex]);
  const auto at = [&](const Page& page) -> const Vec3& { return mesh.vertices[page.apex]; };
  std::stable_sort(pages.begin(), pages.end(),
                   [&](const Page& a, const Page& b) { return less(at(a), at(b)); });
  for (size_t i = 0, first = 0; i < pages.size(); ++i) {
    if (less(at(pages[first]), at(pages[i]))) first = i;
    for (size_t k = first; k < i; ++k) {
      // Triangles with the same three corners are reported once, though they share two sides here.
      if (pages[k].apex == pages[i].apex && pages[i].other > pages[i].apex) continue;
      if (out.size() >= limit) return false;
      out.push_back(ascending(pages[k].triangle, pages[i].triangle));
    }
  }
  return true;
}

}  // namespace

StarArc star_arc(const TriangleMesh& mesh, uint32_t triangle, uint8_t corner) {
  const Vec3& p = mesh.corner(triangle, corner);
  Vec3 a = mesh.corner(triangle, (corner + 1) % 3) - p,
       b = mesh.corner(triangle, (corner + 2) % 3) - p;
  // Scaled before squaring to avoid underflow and overflow.
  a = (a / a.cwiseAbs().maxCoeff()).normalized();
  b = (b / b.cwiseAbs().maxCoeff()).normalized();
  // An arc rises at most 1 - sqrt(1 - c^2 / 4) <= c^2 / 4 above its chord c; the rest covers
  // rounding.
  const double rise = 0.25 * (a - b).squaredNorm() + 1e-12;
  return {a.cwiseMin(b).array() - rise, a.cwiseMax(b).array() + rise, triangle, corner};
}

StarPairs large_star_pairs(const TriangleMesh& mesh, uint32_t vertex, std::vector<StarArc> arcs,
                           size_t limit) {
  StarPairs out;
  std::vector<Page> pages;
  for (const StarArc& arc : arcs) {
    const Triangle& t = mesh.triangles[arc.triangle];
    const uint32_t x = t[(arc.corner + 1u) % 3], y = t[(arc.corner + 2u) % 3];
    pages.push_back({x, y, arc.triangle});
    pages.push_back({y, x, arc.triangle});
  }
  std::sort(pages.begin(), pages.end(), [](const Page& a, const Page& b) {
    return a.other != b.other ? a.other < b.other : a.triangle < b.triangle;
  });
  for (size_t first = 0, i = 1; i <= pages.size(); ++i) {
    if (i < pages.size() && pages[i].other == pages[first].other) continue;
    if (i - first > 1 && out.complete) {
      out.complete = fold_pages(mesh, vertex, {pages.data() + first, i - first}, limit, out.folded);
    }
    first = i;
  }
  out.complete =
      out.complete && ArcTree(mesh, vertex, arcs).each([&](const StarArc& a, const StarArc& b) {
        if (out.loose.size() >= limit) return false;
        out.loose.push_back(ascending(a.triangle, b.triangle));
        return true;
      });
  return out;
}

bool folded_at(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  // Most neighbours are clearly on two sides of it, including flat ones, for which the exact test
  // is slow: each rounding error is below 1e-15 of the size of the products.
  const Vec3 u = q - p, to_a = a - p, to_b = b - p;
  const double size = u.norm() * to_a.norm() * u.norm() * to_b.norm();
  if (u.cross(to_a).dot(u.cross(to_b)) < -1e-12 * size) return false;
  if (orientation(p, q, a, b) != 0) return false;
  for (int k = 0; k < 3; ++k) {
    const auto shadow = [k](const Vec3& v) { return Vec2(v[(k + 1) % 3], v[(k + 2) % 3]); };
    const int turn = orientation(shadow(p), shadow(q), shadow(a));
    if (turn != 0) return turn == orientation(shadow(p), shadow(q), shadow(b));
  }
  return false;
}

}  // namespace tumble
