#include "engine/geometry/solid/self_intersection.hpp"

#include "engine/geometry/hierarchy/aabb_tree.hpp"
#include "engine/geometry/predicates/orientation.hpp"

#include <algorithm>
#include <memory>
#include <numeric>

namespace tumble {
namespace {

/// Twice the area of a triangle's shadow along axis k, exactly signed.
int shadow_turn(const Vec3& a, const Vec3& b, const Vec3& c, int k) {
  const auto flat = [k](const Vec3& p) { return Vec2(p[(k + 1) % 3], p[(k + 2) % 3]); };
  return orientation(flat(a), flat(b), flat(c));
}

/// Two triangles of one plane face the same way.
bool face_alike(const Triangle3& a, const Triangle3& b) {
  for (int k = 0; k < 3; ++k) {
    const int turn = shadow_turn(a[0], a[1], a[2], k);
    if (turn != 0) return turn == shadow_turn(b[0], b[1], b[2], k);
  }
  return false;
}

/// The side p-q with apex a and the same with apex b: folded onto each other.
bool folded(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
  // Most neighbours clearly lie on two sides of it, flat ones too, which the exact test takes long
  // over: each rounding is below 1e-15 of the products' size.
  const Vec3 u = q - p, to_a = a - p, to_b = b - p;
  const double size = u.norm() * to_a.norm() * u.norm() * to_b.norm();
  if (u.cross(to_a).dot(u.cross(to_b)) < -1e-12 * size) return false;
  if (orientation(p, q, a, b) != 0) return false;
  for (int k = 0; k < 3; ++k) {
    const int turn = shadow_turn(p, q, a, k);
    if (turn != 0) return turn == shadow_turn(p, q, b, k);
  }
  return false;
}

/// A triangle seen from one of its corners: the arc between the directions to the other two on the
/// unit sphere, in a box. Two triangles have no point but the corner in common unless arcs meet.
struct Arc {
  Vec3 low, high;
  uint32_t triangle;
  uint8_t corner;
};

Arc arc_of(const TriangleMesh& mesh, uint32_t t, uint8_t corner) {
  const Vec3& p = mesh.corner(t, corner);
  Vec3 a = mesh.corner(t, (corner + 1) % 3) - p, b = mesh.corner(t, (corner + 2) % 3) - p;
  // Scaled before squaring, so that tiny and huge ones have a length.
  a = (a / a.cwiseAbs().maxCoeff()).normalized();
  b = (b / b.cwiseAbs().maxCoeff()).normalized();
  // An arc rises at most 1 - sqrt(1 - c^2 / 4) <= c^2 / 4 above its chord c; the rest is rounding.
  const double rise = 0.25 * (a - b).squaredNorm() + 1e-12;
  return {a.cwiseMin(b).array() - rise, a.cwiseMax(b).array() + rise, t, corner};
}

/// Finds the clashes of one mesh whose equal vertices have equal numbers.
class ClashFinder {
 public:
  ClashFinder(const TriangleMesh& mesh, size_t star_limit) : mesh_(mesh), star_limit_(star_limit) {}

  void stars(std::vector<uint32_t>* crowded) {
    std::vector<uint32_t> first(mesh_.vertices.size() + 1, 0);
    for (const Triangle& t : mesh_.triangles) {
      for (uint32_t v : t) ++first[v + 1];
    }
    for (size_t v = 0; v + 1 < first.size(); ++v) first[v + 1] += first[v];
    std::vector<std::pair<uint32_t, uint8_t>> list(first.back());
    std::vector<uint32_t> cursor(first.begin(), first.end() - 1);
    for (uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      for (uint8_t k = 0; k < 3; ++k) list[cursor[mesh_.triangles[t][k]]++] = {t, k};
    }
    std::vector<Arc> arcs;
    for (uint32_t v = 0; v + 1 < first.size(); ++v) {
      arcs.clear();
      for (uint32_t i = first[v]; i < first[v + 1]; ++i) {
        arcs.push_back(arc_of(mesh_, list[i].first, list[i].second));
      }
      if (!star(arcs) && crowded) crowded->push_back(v);
    }
  }

  void apart_from_stars() {
    const AabbTree tree(std::make_shared<const TriangleMesh>(mesh_));
    std::vector<TriangleIds> pairs;
    tree.self_pairs(0, pairs);
    for (const TriangleIds& ids : pairs) add(ids, relation(ids));
  }

  std::vector<TriangleClash> take() {
    std::sort(found_.begin(), found_.end(),
              [](const TriangleClash& a, const TriangleClash& b) { return a.ids < b.ids; });
    return std::move(found_);
  }

 private:
  TriangleRelation relation(TriangleIds ids) const {
    return triangle_relation(corners(mesh_, ids.a), corners(mesh_, ids.b));
  }

  void add(TriangleIds ids, TriangleRelation relation) {
    const bool alike = relation == TriangleRelation::overlapping &&
                       face_alike(corners(mesh_, ids.a), corners(mesh_, ids.b));
    found_.push_back({ids, relation, alike});
  }

  /// The triangles around one vertex; false when there were too many pairs.
  bool star(std::vector<Arc>& arcs) {
    std::sort(arcs.begin(), arcs.end(), [](const Arc& a, const Arc& b) {
      return a.low.x() != b.low.x() ? a.low.x() < b.low.x() : a.triangle < b.triangle;
    });
    size_t pairs = 0;
    for (size_t i = 0; i < arcs.size(); ++i) {
      for (size_t j = i + 1; j < arcs.size() && arcs[j].low.x() <= arcs[i].high.x(); ++j) {
        if (++pairs > star_limit_) return false;
        if ((arcs[j].low.array() > arcs[i].high.array()).any()) continue;
        if ((arcs[i].low.array() > arcs[j].high.array()).any()) continue;
        neighbours_of(arcs[i], arcs[j]);
      }
    }
    return true;
  }

  void neighbours_of(const Arc& x, const Arc& y) {
    const bool swap = y.triangle < x.triangle;
    const Arc &a = swap ? y : x, &b = swap ? x : y;
    const Triangle &ta = mesh_.triangles[a.triangle], &tb = mesh_.triangles[b.triangle];
    const uint32_t here = ta[a.corner];
    size_t shared = 0;
    uint32_t lowest = no_index, other = no_index;
    for (uint32_t v : ta) {
      if (v != tb[0] && v != tb[1] && v != tb[2]) continue;
      ++shared;
      lowest = std::min(lowest, v);
      if (v != here) other = v;
    }
    if (lowest != here) return;  // looked at from that vertex
    const TriangleIds ids{a.triangle, b.triangle};
    if (shared == 3) return add(ids, TriangleRelation::overlapping);
    const auto apex = [&](const Triangle& t) {
      for (uint32_t v : t) {
        if (v != here && v != other) return mesh_.vertices[v];
      }
      return mesh_.vertices[here];
    };
    if (shared == 2) {
      if (folded(mesh_.vertices[here], mesh_.vertices[other], apex(ta), apex(tb))) {
        add(ids, TriangleRelation::overlapping);
      }
      return;
    }
    // Beyond the common corner: the ray from it through a common point leaves one of the two within
    // the other.
    const auto side = [&](const Arc& arc, size_t k) -> const Vec3& {
      return mesh_.corner(arc.triangle, (arc.corner + k) % 3);
    };
    if (segment_triangle_intersect(side(a, 1), side(a, 2), corners(mesh_, b.triangle)) ||
        segment_triangle_intersect(side(b, 1), side(b, 2), corners(mesh_, a.triangle))) {
      add(ids, relation(ids));
    }
  }

  const TriangleMesh& mesh_;
  size_t star_limit_;
  std::vector<TriangleClash> found_;
};

}  // namespace

std::vector<uint32_t> lowest_equal_vertices(const TriangleMesh& mesh) {
  const auto& v = mesh.vertices;
  std::vector<uint32_t> order(v.size()), lowest(v.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    for (int k = 0; k < 3; ++k) {
      if (v[a][k] != v[b][k]) return v[a][k] < v[b][k];
    }
    return a < b;
  });
  for (size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && v[order[i]] == v[order[i - 1]];
    lowest[order[i]] = same ? lowest[order[i - 1]] : order[i];
  }
  return lowest;
}

std::vector<TriangleClash> self_intersections(const TriangleMesh& mesh,
                                              std::vector<uint32_t>* crowded, size_t star_limit) {
  const std::vector<uint32_t> lowest = lowest_equal_vertices(mesh);
  TriangleMesh welded;
  welded.vertices = mesh.vertices;
  std::vector<uint32_t> id;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (collinear(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2))) continue;
    const Triangle& c = mesh.triangles[t];
    welded.triangles.push_back({lowest[c[0]], lowest[c[1]], lowest[c[2]]});
    id.push_back(t);
  }
  ClashFinder finder(welded, star_limit);
  finder.stars(crowded);
  finder.apart_from_stars();
  std::vector<TriangleClash> out = finder.take();
  for (TriangleClash& c : out) c.ids = {id[c.ids.a], id[c.ids.b]};  // ids ascend with numbers
  return out;
}

}  // namespace tumble
