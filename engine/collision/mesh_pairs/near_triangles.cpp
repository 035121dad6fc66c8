#include "engine/collision/mesh_pairs/near_triangles.hpp"

#include "engine/collision/mesh_pairs/small_surface.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

using Node = AabbTree::Node;

struct HalfBox {
  Vec3 centre, half;
};

HalfBox half_box(const Node& n) {
  HalfBox b;
  for (int k = 0; k < 3; ++k) {
    const double low = double(n.min[size_t(k)]), high = double(n.max[size_t(k)]);
    b.centre[k] = 0.5 * (low + high);
    b.half[k] = 0.5 * (high - low);
  }
  return b;
}

/// Corners and plane of one triangle in A's frame.
struct OwnCorners {
  std::array<Vec3, 3> p;
  Vec3 normal;
  uint32_t id;
  Aabb box() const {
    return {p[0].cwiseMin(p[1]).cwiseMin(p[2]), p[0].cwiseMax(p[1]).cwiseMax(p[2])};
  }
};

/// Distance of t from a plane, if t is on one side of it; negative if it crosses.
double beyond_plane(const OwnCorners& plane, const OwnCorners& t) {
  double low = 0, high = 0;
  for (size_t k = 0; k < 3; ++k) {
    const double h = plane.normal.dot(t.p[k] - plane.p[0]);
    low = k ? std::min(low, h) : h;
    high = k ? std::max(high, h) : h;
  }
  return std::max(low, -high);
}

/// Simultaneous descent of both trees; B's boxes are oriented boxes in A's frame, tested along the
/// six face axes.
class Walk {
 public:
  Walk(const PlacedSurface& A, const PlacedSurface& B, NearPairs& pairs)
      : a_(A.s),
        b_(B.s),
        R_(A.R.transpose() * B.R),
        x_(A.R.transpose() * (B.x - A.x)),
        absolute_(R_.cwiseAbs() + Mat3::Constant(1e-14)),
        pairs_(pairs) {
    offset_ = R_ * b_.tree->origin() + x_ - a_.tree->origin();
    rounding_ = 1e-6 * (a_.size + b_.size);  // boxes are in single precision
  }

  void run(size_t most) {
    thread_local std::vector<TriangleIds> stack;
    stack.assign(1, {0, 0});
    const auto &na = a_.tree->nodes(), &nb = b_.tree->nodes();
    while (!stack.empty() && pairs_.within.size() <= most) {
      const TriangleIds at = stack.back();
      stack.pop_back();
      const Node &m = na[at.a], &n = nb[at.b];
      const HalfBox p = half_box(m), q = half_box(n);
      if (pairs_.apart(between(p, q) - rounding_)) continue;
      if (m.is_leaf() && n.is_leaf()) {
        leaves(m, n);
      } else if (n.is_leaf() || (!m.is_leaf() && p.half.sum() >= q.half.sum())) {
        stack.push_back({m.start, at.b});
        stack.push_back({at.a + 1, at.b});
      } else {
        stack.push_back({at.a, n.start});
        stack.push_back({at.a, at.b + 1});
      }
    }
  }

 private:
  /// Gap between the boxes along the axis where it is greatest; negative if they overlap.
  double between(const HalfBox& p, const HalfBox& q) const {
    const Vec3 d = R_ * q.centre + offset_ - p.centre;
    const double along_a = (d.cwiseAbs() - absolute_ * q.half - p.half).maxCoeff();
    const Vec3 e = R_.transpose() * d;
    const double along_b = (e.cwiseAbs() - absolute_.transpose() * p.half - q.half).maxCoeff();
    return std::max(along_a, along_b);
  }

  void leaves(const Node& m, const Node& n) {
    std::array<OwnCorners, AabbTree::max_leaf_triangles> other;
    for (uint32_t j = 0; j < n.count; ++j) {
      OwnCorners& c = other[j];
      c.id = b_.tree->triangle_order()[n.start + j];
      for (size_t k = 0; k < 3; ++k) c.p[k] = R_ * b_.mesh->corner(c.id, k) + x_;
      c.normal = R_ * b_.topology.face_normals[c.id];
    }
    for (uint32_t i = 0; i < m.count; ++i) {
      OwnCorners own;
      own.id = a_.tree->triangle_order()[m.start + i];
      for (size_t k = 0; k < 3; ++k) own.p[k] = a_.mesh->corner(own.id, k);
      own.normal = a_.topology.face_normals[own.id];
      const Aabb box = own.box();
      for (uint32_t j = 0; j < n.count; ++j) {
        const double between = gap_between(box, other[j].box());
        if (pairs_.apart(between)) continue;
        const double beyond = std::max(beyond_plane(own, other[j]), beyond_plane(other[j], own));
        if (pairs_.apart(beyond)) continue;
        pairs_.add({own.id, other[j].id}, std::max(between, beyond));
      }
    }
  }

  const MeshSurface &a_, &b_;
  Mat3 R_;
  Vec3 x_;
  Mat3 absolute_;
  Vec3 offset_;
  double rounding_ = 0;
  NearPairs& pairs_;
};

/// Ascending by a, then b.
void sort_pairs(std::vector<TriangleIds>& pairs) {
  // As one number: comparing two ids would branch unpredictably.
  std::ranges::sort(pairs, {}, [](const TriangleIds& x) { return uint64_t{x.a} << 32 | x.b; });
}

/// The same for pairs of a small surface that ascend by b: a counting sort by a.
void sort_by_facet(std::vector<TriangleIds>& pairs) {
  if (pairs.empty()) return;
  static thread_local std::vector<TriangleIds> sorted;
  std::array<uint32_t, most_of_small + 1> next{};
  for (const TriangleIds& x : pairs) ++next[x.a + 1];
  for (size_t i = 1; i < next.size(); ++i) next[i] += next[i - 1];
  sorted.resize(pairs.size());
  for (const TriangleIds& x : pairs) sorted[next[x.a]++] = x;
  pairs.swap(sorted);
}

void swap_sides(const std::vector<TriangleIds>& pairs, std::vector<TriangleIds>& swapped) {
  swapped.clear();
  for (const TriangleIds& x : pairs) swapped.push_back({x.b, x.a});
}

/// Orders the pairs of a small surface, which finds them in the order of the other's triangles and
/// then of its own.
void order_small(bool is_a, NearPairs& found, std::vector<TriangleIds>* by_b) {
  if (by_b) swap_sides(found.within, *by_b);
  if (is_a) {
    sort_by_facet(found.within);
    if (found.crossing) sort_by_facet(*found.crossing);
  } else if (by_b) {
    sort_by_facet(*by_b);
  }
}

void order_any(NearPairs& found, std::vector<TriangleIds>* by_b) {
  sort_pairs(found.within);
  if (found.crossing) sort_pairs(*found.crossing);
  if (!by_b) return;
  swap_sides(found.within, *by_b);
  sort_pairs(*by_b);
}

}  // namespace

bool near_triangles(const PlacedSurface& A, const PlacedSurface& B, double reach, size_t most,
                    const HierarchyKind* kind, std::vector<TriangleIds>& pairs, double* apart,
                    std::vector<TriangleIds>* crossing, std::vector<TriangleIds>* by_b) {
  pairs.clear();
  if (crossing) crossing->clear();
  if (apart) *apart = reach;
  if (kind) {
    const Pose b_in_a{A.R.transpose() * (B.x - A.x), Quat(Mat3(A.R.transpose() * B.R))};
    A.s.hierarchies->get(*kind).pairs(B.s.hierarchies->get(*kind), b_in_a, reach, pairs);
    if (crossing) *crossing = pairs;
    if (by_b) swap_sides(pairs, *by_b), sort_pairs(*by_b);
    return pairs.size() <= most;
  }
  NearPairs found{reach, 1e-6 * (A.s.size + B.s.size), pairs, crossing};
  const bool fewer_of_a = A.s.mesh->triangles.size() <= B.s.mesh->triangles.size();
  const bool small_a = is_small(A.s) && (fewer_of_a || !is_small(B.s));
  if (small_a)
    SmallSurface(A, B, true, found).run(most);
  else if (is_small(B.s))
    SmallSurface(B, A, false, found).run(most);
  else
    Walk(A, B, found).run(most);
  if (apart) *apart = found.nearest_left_out;
  if (small_a || is_small(B.s))
    order_small(small_a, found, by_b);
  else
    order_any(found, by_b);
  return pairs.size() <= most;
}

}  // namespace tumble
