#include "engine/geometry/solid/self_intersection.hpp"

#include "engine/geometry/hierarchy/common_vertices.hpp"
#include "engine/geometry/predicates/orientation.hpp"
#include "engine/geometry/solid/meeting_strangers.hpp"
#include "engine/geometry/solid/star_arcs.hpp"

#include <algorithm>
#include <numeric>

namespace tumble {
namespace {

/// Exact sign of twice the area of a triangle's projection along axis k.
int shadow_turn(const Vec3& a, const Vec3& b, const Vec3& c, int k) {
  const auto flat = [k](const Vec3& p) { return Vec2(p[(k + 1) % 3], p[(k + 2) % 3]); };
  return orientation(flat(a), flat(b), flat(c));
}

/// Whether two coplanar triangles face the same way.
bool face_alike(const Triangle3& a, const Triangle3& b) {
  for (int k = 0; k < 3; ++k) {
    const int turn = shadow_turn(a[0], a[1], a[2], k);
    if (turn != 0) return turn == shadow_turn(b[0], b[1], b[2], k);
  }
  return false;
}

/// Finds the self-intersections of one mesh in which equal vertices have equal numbers.
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
    std::vector<StarArc> arcs;
    for (uint32_t v = 0; v + 1 < first.size(); ++v) {
      arcs.clear();
      for (uint32_t i = first[v]; i < first[v + 1]; ++i) {
        arcs.push_back(star_arc(mesh_, list[i].first, list[i].second));
      }
      const bool all = arcs.size() > large_fan ? large_star(v, arcs) : star(arcs, v);
      if (!all && crowded) crowded->push_back(v);
    }
  }

  void apart_from_stars() {
    for (const TriangleIds& ids : meeting_strangers(mesh_)) add(ids, relation(ids));
  }

  std::vector<TriangleClash> take() {
    std::sort(found_.begin(), found_.end(),
              [](const TriangleClash& a, const TriangleClash& b) { return a.ids < b.ids; });
    return std::move(found_);
  }

 private:
  static constexpr size_t large_fan = 48;

  TriangleRelation relation(TriangleIds ids) const {
    return triangle_relation(corners(mesh_, ids.a), corners(mesh_, ids.b));
  }

  void add(TriangleIds ids, TriangleRelation relation) {
    const bool alike = relation == TriangleRelation::overlapping &&
                       face_alike(corners(mesh_, ids.a), corners(mesh_, ids.b));
    found_.push_back({ids, relation, alike});
  }

  /// Tests the triangles around one vertex; false if there were too many pairs.
  bool star(std::vector<StarArc>& arcs, uint32_t here) {
    std::sort(arcs.begin(), arcs.end(), [](const StarArc& a, const StarArc& b) {
      return a.low.x() != b.low.x() ? a.low.x() < b.low.x() : a.triangle < b.triangle;
    });
    size_t pairs = 0;
    for (size_t i = 0; i < arcs.size(); ++i) {
      for (size_t j = i + 1; j < arcs.size() && arcs[j].low.x() <= arcs[i].high.x(); ++j) {
        if (++pairs > star_limit_) return false;
        if (!arcs[i].apart(arcs[j])) {
          neighbours_of(arcs[i].triangle, arcs[j].triangle, here);
        }
      }
    }
    return true;
  }

  bool large_star(uint32_t here, const std::vector<StarArc>& arcs) {
    const StarPairs pairs = large_star_pairs(mesh_, here, arcs, star_limit_);
    for (const TriangleIds& ids : pairs.folded) {
      const Triangle shared = common_vertices(mesh_.triangles[ids.a], mesh_.triangles[ids.b]);
      if (*std::min_element(shared.begin(), shared.end()) == here) {
        add(ids, TriangleRelation::overlapping);
      }
    }
    for (const TriangleIds& ids : pairs.loose) neighbours_of(ids.a, ids.b, here);
    return pairs.complete;
  }

  void neighbours_of(uint32_t x, uint32_t y, uint32_t here) {
    const uint32_t a = std::min(x, y), b = std::max(x, y);
    const Triangle &ta = mesh_.triangles[a], &tb = mesh_.triangles[b];
    size_t shared = 0;
    uint32_t lowest = no_index, other = no_index;
    for (uint32_t v : ta) {
      if (v != tb[0] && v != tb[1] && v != tb[2]) continue;
      ++shared;
      lowest = std::min(lowest, v);
      if (v != here) other = v;
    }
    if (lowest != here) return;  // tested at that vertex
    const TriangleIds ids{a, b};
    if (shared == 3) return add(ids, TriangleRelation::overlapping);
    const auto apex = [&](const Triangle& t) {
      for (uint32_t v : t) {
        if (v != here && v != other) return mesh_.vertices[v];
      }
      return mesh_.vertices[here];
    };
    if (shared == 2) {
      if (folded_at(mesh_.vertices[here], mesh_.vertices[other], apex(ta), apex(tb))) {
        add(ids, TriangleRelation::overlapping);
      }
      return;
    }
    // Beyond the common corner: the ray from it through a common point leaves one of the triangles
    // within the other.
    const auto crosses = [&](const Triangle& t, uint32_t other_triangle) {
      const auto corner = size_t(std::find(t.begin(), t.end(), here) - t.begin());
      return segment_triangle_intersect(mesh_.vertices[t[(corner + 1) % 3]],
                                        mesh_.vertices[t[(corner + 2) % 3]],
                                        corners(mesh_, other_triangle));
    };
    if (crosses(ta, b) || crosses(tb, a)) {
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
