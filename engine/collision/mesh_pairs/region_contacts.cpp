#include "engine/collision/feature_key.hpp"
#include "engine/collision/mesh_pairs/overlap_regions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Limit of the pairs of edges that are tested: a region with more has enough vertices.
constexpr size_t max_edge_pairs = 4096;

/// In regions lower than this share of the smaller surface, faces cross by rounding alone: their
/// columns are limited to `most_heights` heights, since rays miss the face and hit whatever is far
/// behind it. In other regions a point may be far behind the contour, as of a needle through a
/// plate.
constexpr double hair_share = 1e-6;
constexpr double most_heights = 2;

struct Columns {
  const PlacedSurface &A, &B;
  const Vec3& n;
  double deepest;   ///< of the column in the middle of the contour [m]
  double farthest;  ///< longest distance from a vertex to its exit [m]
  std::vector<FeatureContact>& contacts;
};

/// Contact of a vertex of V, inside F, that leaves along `out` (unit, query frame).
void vertex_column(const Columns& c, bool of_a, uint32_t vertex) {
  const PlacedSurface &V = of_a ? c.A : c.B, &F = of_a ? c.B : c.A;
  const Vec3 out = of_a ? Vec3(-c.n) : c.n;
  const Vec3 x = V.vertex(vertex);
  const Ray ray{F.R.transpose() * (x - F.x), F.local_direction(out)};
  const auto hit = F.s.tree->ray(ray, F.s.size);
  if (!hit || hit->front || hit->t > c.farthest) return;
  const uint64_t key = mix_key(feature_key(FeaturePair::vertex_face, vertex, 0), of_a ? 0 : 1);
  c.contacts.push_back({x + 0.5 * hit->t * out, c.n, -hit->t, key});
}

/// Contact of two pieces of edges that cross, seen along the normal.
void edge_column(const Columns& c, const InsidePiece& a, const InsidePiece& b) {
  const auto &ea = c.A.s.topology.edges[a.edge].vertices,
             &eb = c.B.s.topology.edges[b.edge].vertices;
  const Vec3 p = c.A.vertex(ea[0]), q = c.B.vertex(eb[0]);
  const Vec3 u = c.A.vertex(ea[1]) - p, w = c.B.vertex(eb[1]) - q;
  const double area = c.n.dot(u.cross(w));
  if (!(std::abs(area) > 1e-6 * u.norm() * w.norm())) return;
  const Vec3 r = q - p;
  const double s = c.n.dot(r.cross(w)) / area, t = c.n.dot(r.cross(u)) / area;
  // Edges that cross faces parallel to the normal end exactly above each other.
  constexpr double slack = 1e-7;
  if (s < a.from - slack || s > a.to + slack || t < b.from - slack || t > b.to + slack) return;
  const Vec3 on_a = p + s * u, on_b = q + t * w;
  const double depth = c.n.dot(on_a - on_b);
  if (depth <= 0) return;
  c.contacts.push_back(
      {0.5 * (on_a + on_b), c.n, -depth, feature_key(FeaturePair::edge_edge, a.edge, b.edge)});
}

template <class Item>
std::span<const Item> of_region(const std::vector<Item>& items, uint32_t region) {
  const auto first = std::partition_point(items.begin(), items.end(),
                                          [&](const Item& i) { return i.region < region; });
  const auto last =
      std::partition_point(first, items.end(), [&](const Item& i) { return i.region == region; });
  return {first, last};
}

void edge_columns(const Columns& c, std::span<const InsidePiece> a,
                  std::span<const InsidePiece> b) {
  const auto active = [](const PlacedSurface& S, std::span<const InsidePiece> pieces) {
    return size_t(std::count_if(pieces.begin(), pieces.end(), [&](const InsidePiece& p) {
      return S.s.edge_active[p.edge] != 0;
    }));
  };
  if (active(c.A, a) * active(c.B, b) > max_edge_pairs) return;
  for (const InsidePiece& i : a) {
    if (!c.A.s.edge_active[i.edge]) continue;
    for (const InsidePiece& j : b)
      if (c.B.s.edge_active[j.edge]) edge_column(c, i, j);
  }
}

/// The column through the middle of the contour, if the surfaces overlap there.
void middle_column(const Columns& c, const OverlapRegion& r, uint32_t region) {
  const Vec3 beyond = (r.height + c.deepest) * c.n;
  const Vec3 above = r.centre + beyond, below = r.centre - beyond;
  const double length = 2 * beyond.norm();
  const auto on_a =
      c.A.s.tree->ray({c.A.R.transpose() * (above - c.A.x), c.A.local_direction(-c.n)}, length);
  const auto on_b =
      c.B.s.tree->ray({c.B.R.transpose() * (below - c.B.x), c.B.local_direction(c.n)}, length);
  if (!on_a || !on_b || !on_a->front || !on_b->front) return;
  const double depth = length - on_a->t - on_b->t;
  if (!(depth > 0) || depth > c.deepest) return;
  const Vec3 x = below + (on_b->t + 0.5 * depth) * c.n;
  c.contacts.push_back({x, c.n, -depth, feature_key(FeaturePair::closest, 0, region)});
}

}  // namespace

void region_contacts(const PlacedSurface& A, const PlacedSurface& B, OverlapRegions& regions,
                     uint32_t region, std::vector<FeatureContact>& contacts) {
  OverlapRegion& r = regions.regions[region];
  if (r.normal.isZero(0)) return;
  const size_t first = contacts.size();
  const double hair = hair_share * std::min(A.s.size, B.s.size);
  const double deepest = most_heights * r.height + hair;
  const double farthest = r.height > hair ? std::numeric_limits<double>::infinity() : deepest;
  const Columns columns{A, B, r.normal, deepest, farthest, contacts};
  for (size_t side = 0; side < 2; ++side)
    for (const InsideVertex& v : of_region(regions.vertices[side], region))
      if ((side ? B : A).s.vertex_active[v.vertex]) vertex_column(columns, side == 0, v.vertex);
  edge_columns(columns, of_region(regions.pieces[0], region), of_region(regions.pieces[1], region));
  if (contacts.size() == first) middle_column(columns, r, region);
  r.depth = std::min(r.height, hair);
  for (size_t i = first; i < contacts.size(); ++i) r.depth = std::max(r.depth, -contacts[i].gap);
}

}  // namespace tumble
