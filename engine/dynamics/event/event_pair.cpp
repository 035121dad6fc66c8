#include "engine/dynamics/event/event_pair.hpp"

#include "engine/collision/convex_pairs/pair.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/dynamics/event/prices.hpp"
#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Whether a manifold accounts for the overlap of two pieces: along its normal they overlap no more
/// than its points.
bool explains(const Manifold& m, const PairShapes& s, const PiecePair& pieces) {
  double least = -tolerances::seen_depth;
  for (int i = 0; i < m.count; ++i) least = std::min(least, m.points[size_t(i)].gap);
  return piece_separation(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pieces, m.normal) >=
         least - tolerances::same_depth;
}

/// Pieces of meshes that have just begun to overlap and have no contact, because a manifold holds
/// only four points and the back of a sheet has none: their deepest points become contacts.
void unexplained_pieces(const PairShapes& s, const HierarchyKind* hierarchy,
                        std::vector<Manifold>& out) {
  std::vector<PiecePair> pieces;
  near_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, 0, hierarchy, pieces);
  for (const PiecePair& p : pieces) {
    const PairGap g = piece_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, p, 0, Vec3::Zero());
    if (!g.near || g.gap > -tolerances::seen_depth || g.gap < -tolerances::just_in) continue;
    if (std::any_of(out.begin(), out.end(), [&](const Manifold& m) { return explains(m, s, p); }))
      continue;
    out.push_back(nearest_point(g));
  }
}

}  // namespace

Manifold nearest_point(const PairGap& g) {
  Manifold m;
  m.normal = g.normal;
  m.part = second_manifold;
  m.count = 1;
  m.points[0] = {0.5 * (g.on_a + g.on_b), g.gap, 0};
  return m;
}

void find_manifolds(const PairShapes& s, EventPair& pair, NarrowPhase narrow_phase,
                    const HierarchyKind* hierarchy, std::vector<Manifold>& out) {
  ContactQuery query(pair.margin, hierarchy);
  query.by_triangles = true;
  if (!has_pair_gap(*s.sa.shape, *s.sb.shape)) {
    charge_work(prices::tree_search);
    narrow_phase(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, query, out);
    const double near = std::min(pair.margin, tolerances::far_off_of_size * s.size());
    pair.gap = nearest_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, near, hierarchy).gap;
    if (pair.gap.near && pair.gap.gap < -tolerances::seen_depth)
      unexplained_pieces(s, hierarchy, out);
    return;
  }
  const Vec3 start = pair.gap.near ? pair.gap.normal : Vec3(Vec3::Zero());
  pair.gap = pair_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pair.margin, start);
  if (pair.gap.near)
    pair_manifolds(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, query, pair.gap, narrow_phase, out);
}

void pieces_of_pair(const EventPair& pair, std::span<const RigidBody> bodies, double reach,
                    const HierarchyKind* hierarchy, std::vector<PiecePair>& out) {
  const PairShapes s(pair, bodies);
  near_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, reach, hierarchy, out);
}

PairGap gap_of_pieces(const EventPair& pair, const PiecePair& pieces,
                      std::span<const RigidBody> bodies, double margin, const Vec3& towards_b) {
  const PairShapes s(pair, bodies);
  return piece_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pieces, margin, towards_b);
}

PairGap gap_of_pair(const EventPair& pair, std::span<const RigidBody> bodies, double margin,
                    const HierarchyKind* hierarchy) {
  const PairShapes s(pair, bodies);
  if (!has_pair_gap(*s.sa.shape, *s.sb.shape))
    return nearest_pieces(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, margin, hierarchy).gap;
  const Vec3 start = pair.gap.near ? pair.gap.normal : Vec3(Vec3::Zero());
  return pair_gap(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, margin, start);
}

double separation_of_pieces(const EventPair& pair, const PiecePair& pieces,
                            std::span<const RigidBody> bodies, const Vec3& n) {
  const PairShapes s(pair, bodies);
  return piece_separation(*s.sa.shape, s.at_a, *s.sb.shape, s.at_b, pieces, n);
}

}  // namespace tumble
