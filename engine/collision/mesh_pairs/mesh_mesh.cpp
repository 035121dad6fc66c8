#include "engine/collision/mesh_pairs/mesh_mesh.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/collision/mesh_pairs/near_triangles.hpp"
#include "engine/collision/mesh_pairs/open_side.hpp"
#include "engine/collision/mesh_pairs/overlap_regions.hpp"
#include "engine/collision/mesh_pairs/owned_edges.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"

#include <algorithm>
#include <limits>

namespace tumble {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
/// Values of ContactRange::cone; the second is used where surfaces cross and no feature is valid
/// otherwise.
constexpr double strict_cone = 0.6, any_cone = 2;

/// Limit of the pairs of triangles that are tested: for fine meshes the range is reduced.
constexpr size_t max_pairs = 20000;

/// Scratch memory that is kept from pair to pair.
struct Scratch {
  std::vector<TriangleIds> pairs, by_b, crossing;
  std::vector<uint32_t> near_a, near_b;
  std::vector<FeatureContact> contacts;
  std::vector<SunkVertex> sunk_a, sunk_b;
  std::vector<PlacedEdge> edges_a;  ///< of the current triangle
  OwnedEdges edges_b;
  double apart = 0;  ///< bound on the distance of surfaces without near pairs [m]
  OpenSides sides_a, sides_b;
  std::vector<TriangleIds> all_pairs, all_crossing;
  std::vector<FeatureContact> all_contacts;
};

struct MeshQuery {
  PlacedSurface A, B;
  ContactRange range;
  Scratch& scratch;
  const HierarchyKind* hierarchy;
};

/// End of the run of pairs with the same first id that starts at `first`.
size_t end_of_run(const std::vector<TriangleIds>& pairs, size_t first) {
  size_t last = first + 1;
  while (last < pairs.size() && pairs[last].a == pairs[first].a) ++last;
  return last;
}

/// The second ids of the pairs from `first` to before `last`.
void read_run(const std::vector<TriangleIds>& pairs, size_t first, size_t last,
              std::vector<uint32_t>& ids) {
  ids.clear();
  for (size_t i = first; i < last; ++i) ids.push_back(pairs[i].b);
}

/// The second ids of all pairs with this first id.
void read_run_of(const std::vector<TriangleIds>& pairs, uint32_t id, std::vector<uint32_t>& ids) {
  const auto first = size_t(std::ranges::lower_bound(pairs, TriangleIds{id, 0}) - pairs.begin());
  read_run(pairs, first, end_of_run(pairs, first), ids);
}

/// Vertices of one surface against the triangles of the other; `pairs` is sorted by the first id,
/// which belongs to the surface of the vertices.
void vertex_stage(const MeshQuery& q, bool of_a, const std::vector<TriangleIds>& pairs,
                  std::vector<SunkVertex>& sunk) {
  const PlacedSurface &V = of_a ? q.A : q.B, &F = of_a ? q.B : q.A;
  auto& contacts = q.scratch.contacts;
  const size_t first_contact = contacts.size();
  for (size_t first = 0; first < pairs.size() && !stop_requested();) {
    const uint32_t t = pairs[first].a;
    const size_t begin = first;
    first = end_of_run(pairs, begin);
    charge_work(first - begin, 500);
    if ((V.s.owned[t] & 7u) == 0) continue;
    read_run(pairs, begin, first, q.scratch.near_b);
    for (unsigned k = 0; k < 3; ++k)
      if (V.s.owned[t] & (1u << k))
        vertex_contacts(V, V.s.mesh->triangles[t][k], F, q.scratch.near_b, q.range, contacts, sunk);
  }
  for (size_t i = first_contact; i < contacts.size(); ++i) {
    // the normal points out of F; it should point from A to B
    if (of_a) contacts[i].normal = -contacts[i].normal;
    contacts[i].key = mix_key(contacts[i].key, of_a ? 0 : 1);
  }
  std::sort(sunk.begin(), sunk.end(),
            [](const SunkVertex& x, const SunkVertex& y) { return x.vertex < y.vertex; });
}

/// Whether x (query frame) is inside the solid or on its surface.
bool inside(const PlacedSurface& S, const Vec3& x, std::span<const uint32_t> triangles,
            double depth) {
  const NearestFeature near =
      nearest_feature(S.s, S.R.transpose() * (x - S.x), triangles, 1.1 * depth);
  return near.triangle != no_index && (near.inside || near.distance < 1e-9 * S.s.size);
}

/// Whether an end of the edge is less deep in the other solid and leaves it in another direction:
/// then that end touches, and the edges only appear to overlap deeply.
bool end_leaves_otherwise(const MeshEdge& edge, const std::vector<SunkVertex>& sunk, double depth,
                          const Vec3& out) {
  for (uint32_t v : edge.vertices) {
    const auto it =
        std::lower_bound(sunk.begin(), sunk.end(), v,
                         [](const SunkVertex& s, uint32_t vertex) { return s.vertex < vertex; });
    if (it == sunk.end() || it->vertex != v) continue;
    if (it->depth < depth && it->out.dot(out) < 0.7) return true;
  }
  return false;
}

void edge_pair(const MeshQuery& q, const TriangleIds& ids, const PlacedEdge& a,
               const PlacedEdge& b) {
  const auto c = edge_contact(q.A, a, q.B, b, q.range);
  if (!c) return;
  Scratch& s = q.scratch;
  if (c->gap < 0) {
    const double depth = -c->gap;
    if (end_leaves_otherwise(q.A.s.topology.edges[a.id], s.sunk_a, depth, -c->normal)) return;
    if (end_leaves_otherwise(q.B.s.topology.edges[b.id], s.sunk_b, depth, c->normal)) return;
    read_run_of(s.pairs, ids.a, s.near_b);
    if (!inside(q.B, c->on_a, s.near_b, depth)) return;
    read_run_of(s.by_b, ids.b, s.near_a);
    if (!inside(q.A, c->on_b, s.near_a, depth)) return;
  }
  s.contacts.push_back({0.5 * (c->on_a + c->on_b), c->normal, c->gap,
                        feature_key(FeaturePair::edge_edge, a.id, b.id)});
}

void edge_stage(const MeshQuery& q) {
  Scratch& s = q.scratch;
  const auto& pairs = s.pairs;
  charge_work(pairs.size(), 1000);
  s.edges_b.place(q.B, s.by_b);
  if (s.edges_b.empty()) return;
  for (size_t first = 0; first < pairs.size() && !stop_requested();) {
    const size_t last = end_of_run(pairs, first);
    s.edges_a.clear();
    const bool any = owns_edges(q.A.s, pairs[first].a);
    for (; first < last; ++first) {
      if (!any || !owns_edges(q.B.s, pairs[first].b)) continue;
      if (s.edges_a.empty()) place_edges(q.A, pairs[first].a, s.edges_a);
      for (const PlacedEdge& a : s.edges_a)
        for (const PlacedEdge& b : s.edges_b.of(pairs[first].b)) edge_pair(q, pairs[first], a, b);
    }
  }
}

/// Collects the pairs of triangles within the range; false when there are too many.
bool gather(const MeshQuery& q) {
  return near_triangles(q.A, q.B, std::max(q.range.margin, q.range.reach), max_pairs, q.hierarchy,
                        q.scratch.pairs, &q.scratch.apart, &q.scratch.crossing, &q.scratch.by_b);
}

/// All contacts within the range; returns the least gap found.
double find_contacts(const MeshQuery& q) {
  Scratch& s = q.scratch;
  s.contacts.clear(), s.sunk_a.clear(), s.sunk_b.clear();
  double least = infinity;
  vertex_stage(q, true, s.pairs, s.sunk_a);
  vertex_stage(q, false, s.by_b, s.sunk_b);
  edge_stage(q);
  for (const FeatureContact& c : s.contacts) least = std::min(least, c.gap);
  return least;
}

/// Whether some point of one solid is inside the other; their surfaces do not cross.
bool contained(const PlacedSurface& inner, const PlacedSurface& outer) {
  const Aabb &small = inner.s.tree->bounds(), &large = outer.s.tree->bounds();
  if (!outer.s.closed || (small.extent().squaredNorm() > large.extent().squaredNorm()))
    return false;
  const Vec3 p = outer.R.transpose() * (inner.vertex(inner.s.mesh->triangles[0][0]) - outer.x);
  if (!large.contains(p)) return false;
  const auto hit = outer.s.tree->ray({p, Vec3(0.577, 0.211, -0.789)}, 2 * outer.s.size);
  return hit && !hit->front;
}

void drop_penetrations(std::vector<FeatureContact>& contacts) {
  std::erase_if(contacts, [](const FeatureContact& c) { return c.gap < 0; });
}

/// Finds where the surfaces cross; false if they do not. Coincident faces and edges make contours
/// that do not close: then, and if features suggest an overlap that has no contour, the search is
/// repeated with B displaced by a tiny amount.
bool overlapping(const MeshQuery& q, bool claimed, OverlapContours& contours,
                 OverlapRegions& regions) {
  const double hair = 1e-7 * std::min(q.A.s.size, q.B.s.size);
  for (const double aside : {0.0, hair, -3 * hair}) {
    const PlacedSurface B{q.B.s, q.B.R, q.B.x + aside * Vec3(0.53, -0.37, 0.76)};
    find_contours(q.A, B, q.scratch.crossing, contours);
    if (!contours.crossing() && (!claimed || aside < 0)) return false;
    if (!contours.crossing()) continue;
    find_regions(q.A, B, contours, regions);
    if (regions.sound) break;
  }
  return true;
}

/// Checks contacts that penetrate against the regions of overlap. A feature's contact is dropped if
/// it is in no region, if its direction opposes its region's normal, or if it is deeper than the
/// region; the region's own contacts are added if features do not account for its depth.
class Arbiter {
 public:
  Arbiter(const MeshQuery& q, OverlapRegions& regions, std::vector<FeatureContact>& own)
      : q_(q), regions_(regions), own_(own) {}

  void run() {
    auto& contacts = q_.scratch.contacts;
    for (uint32_t i = 0; i < regions_.regions.size(); ++i) {
      OverlapRegion& r = regions_.regions[i];
      own_.clear();
      region_contacts(q_.A, q_.B, regions_, i, own_);
      if (r.normal.isZero(0)) continue;
      const bool deep = r.depth > shallow(r);
      // contacts ahead of features that stick out on the far side would hold them there
      const Aabb around = r.box.inflated(r.depth + 1e-9 * q_.A.s.size);
      double explained = 0;
      std::erase_if(contacts, [&](const FeatureContact& c) {
        if (!around.contains(c.x)) return false;
        const double along = c.normal.dot(r.normal);
        if (c.gap >= 0) return along < (deep ? 0.5 : -0.3);
        if (deep || along < 0.3 || -c.gap > 1.5 * r.depth + 1e-9 * q_.A.s.size) return true;
        explained = std::max(explained, -c.gap);
        return false;
      });
      if (explained < 0.7 * r.depth) contacts.insert(contacts.end(), own_.begin(), own_.end());
    }
    if (!regions_.sound) return;
    std::erase_if(contacts, [&](const FeatureContact& c) {
      return c.gap < 0 &&
             std::none_of(
                 regions_.regions.begin(), regions_.regions.end(), [&](const OverlapRegion& r) {
                   return r.box.inflated(r.depth - c.gap + 1e-9 * q_.A.s.size).contains(c.x);
                 });
    });
  }

 private:
  /// Depth up to which contacts of the nearest features are reliable [m].
  double shallow(const OverlapRegion&) const {
    const double thin = std::min(q_.A.s.min_thickness, q_.B.s.min_thickness);
    return std::min(q_.range.reach, 0.2 * thin);
  }

  const MeshQuery& q_;
  OverlapRegions& regions_;
  std::vector<FeatureContact>& own_;
};

/// Leaves the contacts of all pairs in scratch.contacts.
void find_true_contacts(const MeshQuery& q) {
  thread_local OverlapContours contours;
  thread_local OverlapRegions regions;
  thread_local std::vector<FeatureContact> own;
  const double least = find_contacts(q);
  if (stop_requested()) return;
  if (overlapping(q, least < 0, contours, regions)) {
    Arbiter(q, regions, own).run();
  } else if (!contained(q.A, q.B) && !contained(q.B, q.A)) {
    drop_penetrations(q.scratch.contacts);
  }
}

/// The same where an open surface has the other in front of it in one part and behind it in
/// another: the pairs of each side by themselves.
template <class Seen>
void find_contacts_by_sides(Scratch& s, const Seen& seen) {
  s.all_pairs = s.pairs;
  s.all_crossing = s.crossing;
  s.all_contacts.clear();
  for (const bool a_reversed : {false, true})
    for (const bool b_reversed : {false, true}) {
      const auto belongs = [&](const TriangleIds& pair) {
        return s.sides_a.behind(pair.a, pair.b) == a_reversed &&
               s.sides_b.behind(pair.b, pair.a) == b_reversed;
      };
      s.pairs.clear(), s.crossing.clear(), s.by_b.clear();
      std::ranges::copy_if(s.all_pairs, std::back_inserter(s.pairs), belongs);
      std::ranges::copy_if(s.all_crossing, std::back_inserter(s.crossing), belongs);
      if (s.pairs.empty()) continue;
      for (const TriangleIds& pair : s.pairs) s.by_b.push_back({pair.b, pair.a});
      std::sort(s.by_b.begin(), s.by_b.end());
      find_true_contacts(seen(a_reversed, b_reversed));
      s.all_contacts.insert(s.all_contacts.end(), s.contacts.begin(), s.contacts.end());
    }
  s.contacts.swap(s.all_contacts);
}

}  // namespace

void collide_mesh_mesh(const ShapePair& pair, std::vector<Manifold>& out) {
  thread_local Scratch scratch;
  const MeshSurface &a = pair.a.polyhedral()->surface(), &b = pair.b.polyhedral()->surface();
  MeshQuery found{{a, pair.pose_a.q.toRotationMatrix(), pair.pose_a.x},
                  {b, pair.pose_b.q.toRotationMatrix(), pair.pose_b.x},
                  {pair.margin, 0, strict_cone},
                  scratch,
                  pair.hierarchy};
  const double size = std::min(a.size, b.size);
  ContactRange& range = found.range;
  range.reach = std::max(pair.margin, 0.01 * size);
  while (!gather(found) && range.reach > 1e-5 * size) {
    range.reach *= 0.5;
    range.margin = std::min(range.margin, range.reach);
  }
  if (scratch.pairs.empty()) {
    // What one holds inside it is looked at as soon as it is within reach.
    pair.found_apart(scratch.apart - (range.reach - range.margin), a.size + b.size);
    return;
  }
  const double near = std::max(range.margin, range.reach);
  const auto before = [&](size_t k) { return pair.start ? (*pair.start)[k] : PolyhedronFeature{}; };
  OpenSides &of_a = scratch.sides_a, &of_b = scratch.sides_b;
  of_a.find(found.A, found.B, !pair.b.is_mesh(), near, before(0), scratch.by_b, scratch.pairs);
  of_b.find(found.B, found.A, !pair.a.is_mesh(), near, before(1), scratch.pairs, scratch.by_b);
  const auto seen = [&](bool a_reversed, bool b_reversed) {
    return MeshQuery{{a_reversed ? pair.a.polyhedral()->reversed() : a, found.A.R, found.A.x},
                     {b_reversed ? pair.b.polyhedral()->reversed() : b, found.B.R, found.B.x},
                     range,
                     scratch,
                     pair.hierarchy};
  };
  if (of_a.mixed() || of_b.mixed()) {
    find_contacts_by_sides(scratch, seen);
  } else {
    find_true_contacts(seen(of_a.all_behind(), of_b.all_behind()));
  }
  if (stop_requested()) return;
  const size_t first = out.size();
  emit_patches(pair, scratch.contacts, out);
  for (size_t i = first; i < out.size(); ++i) out[i].closest = {of_a.kept(), of_b.kept()};
}

}  // namespace tumble
