// The exhaustive search behind V-Clip.
#include "engine/collision/v_clip/clip_edge.hpp"
#include "engine/collision/v_clip/separating_plane.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::vclip {
namespace {

/// The features of one body that reach into the slab, with its vertices in frame 0.
struct Candidates {
  std::vector<Vec3> vertices;
  std::vector<uint32_t> near_vertices, near_edges, near_faces;
};

/// `heights` of the vertices along the inward normal of the slab; features below `limit` are kept.
void keep_near(const VoronoiPolyhedron& model, const std::vector<double>& heights, double limit,
               Candidates& c) {
  const auto near = [&](uint32_t v) { return heights[v] <= limit; };
  for (uint32_t v = 0; v < heights.size(); ++v)
    if (near(v)) c.near_vertices.push_back(v);
  for (uint32_t e = 0; e < model.edges.size(); ++e) {
    const auto& ends = model.edges[e].vertices;
    if (near(ends[0]) || near(ends[1])) c.near_edges.push_back(e);
  }
  for (uint32_t f = 0; f < model.faces.size(); ++f) {
    const auto sides = model.sides_of(model.faces[f]);
    const bool any = std::any_of(sides.begin(), sides.end(), [&](const VoronoiSide& s) {
      return near(model.edges[s.edge].vertices[0]) || near(model.edges[s.edge].vertices[1]);
    });
    if (any) c.near_faces.push_back(f);
  }
}

/// Keeps the features of A and B in which nearest points no further apart than `distance` must lie:
/// n.(b - a) <= distance leaves each no more than `slack` behind its supporting plane across n.
std::array<Candidates, 2> candidates(const Walk& walk, const Vec3& n, double distance) {
  std::array<Candidates, 2> out;
  std::array<std::vector<double>, 2> heights;
  std::array<double, 2> lowest;
  for (size_t k = 0; k < 2; ++k) {
    for (const Vec3& v : walk.side[k].model->vertices) {
      out[k].vertices.push_back(k == 0 ? v : walk.side[1].to_other(v));
      heights[k].push_back(k == 0 ? -n.dot(v) : n.dot(out[k].vertices.back()));
    }
    lowest[k] = *std::min_element(heights[k].begin(), heights[k].end());
  }
  const double gap = lowest[1] + lowest[0];
  const double slack = std::max(distance - gap, 0.0) + 2 * walk.epsilon;
  for (size_t k = 0; k < 2; ++k)
    keep_near(*walk.side[k].model, heights[k], lowest[k] + slack, out[k]);
  return out;
}

/// The nearest pair of features so far.
struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  Answer found;
  ClosestFeatures at;
};

void compare_edges(const Walk& walk, const std::array<Candidates, 2>& c, Nearest& best) {
  const auto feature = [](const VoronoiEdge& e, uint32_t index, double s) -> PolyhedronFeature {
    if (s <= 0) return {FeatureKind::vertex, e.vertices[0]};
    if (s >= e.length) return {FeatureKind::vertex, e.vertices[1]};
    return {FeatureKind::edge, index};
  };
  for (uint32_t i : c[0].near_edges) {
    const VoronoiEdge& e = walk.side[0].model->edges[i];
    for (uint32_t j : c[1].near_edges) {
      const VoronoiEdge& f = walk.side[1].model->edges[j];
      const Vec3& tail = c[1].vertices[f.vertices[0]];
      const Vec3 along = walk.side[1].turn(f.direction);
      const SegmentsNearest near =
          nearest_of_segments(e.tail, e.direction, e.length, tail, along, f.length);
      const double d = near.gap.norm();
      if (!(d < best.distance)) continue;
      best.distance = d;
      best.at = {feature(e, i, near.s), feature(f, j, near.t)};
      best.found.frame = 0;
      best.found.points = {e.tail + near.s * e.direction, tail + near.t * along};
      best.found.normal = d > 0 ? Vec3(near.gap / d) : Vec3(Vec3::Zero());
    }
  }
}

void compare_faces(const Walk& walk, size_t iv, const std::array<Candidates, 2>& c, Nearest& best) {
  const VoronoiPolyhedron& model = *walk.side[1 - iv].model;
  for (uint32_t v : c[iv].near_vertices) {
    const Vec3 p = walk.side[iv].to_other(walk.side[iv].model->vertices[v]);
    for (uint32_t i : c[1 - iv].near_faces) {
      const VoronoiFace& f = model.faces[i];
      const double height = f.normal.dot(p) - f.offset;
      if (!(height >= -walk.touching && height < best.distance)) continue;
      const auto sides = model.sides_of(f);
      const bool over = std::all_of(sides.begin(), sides.end(), [&](const VoronoiSide& s) {
        return s.inward.dot(p) >= s.offset - walk.epsilon;
      });
      if (!over) continue;
      best.distance = std::max(height, 0.0);
      best.at[iv] = {FeatureKind::vertex, v};
      best.at[1 - iv] = {FeatureKind::face, i};
      best.found.frame = 1 - iv;
      best.found.points[iv] = p;
      best.found.points[1 - iv] = p - height * f.normal;
      best.found.normal = iv == 1 ? f.normal : Vec3(-f.normal);
    }
  }
}

}  // namespace

Move search_all(Walk& walk) {
  const PartingDirection plane = parting_direction(walk);
  if (plane.gap < -walk.touching) return Move::penetrating;
  const Vec3& n = plane.normal;
  Nearest best;
  best.found.points = {Vec3::Zero(), Vec3::Zero()};
  // The slab is based on an estimate of the distance; the search is repeated with the distance
  // found.
  for (double bound = plane.distance; best.distance > bound; bound = best.distance) {
    const auto near = candidates(walk, n, bound);
    compare_edges(walk, near, best);
    compare_faces(walk, 0, near, best);
    compare_faces(walk, 1, near, best);
    if (!(best.distance < std::numeric_limits<double>::infinity())) return Move::penetrating;
  }
  walk.found = best.found;
  walk.found.distance = best.distance;
  if (best.distance <= walk.touching)
    walk.found.normal = best.found.frame == 0 ? n : walk.side[0].turn(n);
  walk.at = best.at;
  return Move::arrived;
}

}  // namespace tumble::vclip
