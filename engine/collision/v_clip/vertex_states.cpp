// The states of V-Clip with a vertex.
#include "engine/collision/v_clip/clip_edge.hpp"
#include "engine/collision/v_clip/walk.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::vclip {
namespace {

PolyhedronFeature vertex(uint32_t i) {
  return {FeatureKind::vertex, i};
}
PolyhedronFeature edge(uint32_t i) {
  return {FeatureKind::edge, i};
}

struct WorstSpoke {
  const VoronoiSpoke* spoke = nullptr;
  double excess = -std::numeric_limits<double>::infinity();  ///< [m]
};

/// The VE plane of vertex `v` that the point `r` away from it violates most.
WorstSpoke worst_spoke(const VoronoiPolyhedron& model, uint32_t v, const Vec3& r) {
  WorstSpoke worst;
  for (const VoronoiSpoke& s : model.spokes_of(v)) {
    const double excess = s.direction.dot(r);
    if (excess > worst.excess) worst = {&s, excess};
  }
  return worst;
}

/// Writes the result for points that are `r` apart, of which the first is on side `from`; the
/// slopes along the neighbouring edges and faces are at most `excess` [m] over a length of |r|.
Move answer_of_points(Walk& walk, size_t frame, size_t from, const Vec3& first, const Vec3& second,
                      const Vec3& r, double excess) {
  Answer& found = walk.found;
  found.frame = frame;
  found.points[from] = first;
  found.points[1 - from] = second;
  found.distance = r.norm();
  const double inverse = found.distance > 0 ? 1 / found.distance : 0;
  found.normal = r * (from == 0 ? inverse : -inverse);
  found.overshoot = excess > 0 ? excess * inverse * walk.reach : 0;
  return Move::arrived;
}

/// State vertex-edge where the nearest point of e, lambda = `nearest`, is outside V(v): e is
/// clipped by the VE planes of v, and the derivative of the distance where e enters or leaves says
/// behind which plane the nearest point lies.
uint32_t edge_beyond(const Walk& walk, size_t iv, uint32_t v, const VoronoiEdge& e, double nearest,
                     uint32_t fallback) {
  const VoronoiPolyhedron& model = *walk.side[iv].model;
  const Side& E = walk.side[1 - iv];
  const Vec3 tail = E.to_other(e.tail) - model.vertices[v];
  const Vec3 along = E.turn(e.direction) * e.length;
  ClippedEdge clipped;
  for (const VoronoiSpoke& s : model.spokes_of(v)) {
    const double d = s.direction.dot(tail);
    if (!clipped.cut(-d, -(d + s.direction.dot(along)), s.edge)) break;
  }
  if (clipped.simply_excluded) return clipped.min_neighbour;
  if (clipped.min_neighbour != ClippedEdge::none && clipped.min > nearest)
    return clipped.min_neighbour;
  if (clipped.max_neighbour != ClippedEdge::none && clipped.max < nearest)
    return clipped.max_neighbour;
  return fallback;  // rounding
}

/// State vertex-face with v below f and no edge of v rising to it: a local minimum. The face whose
/// plane is furthest below v, or penetration when v is below all planes.
Move leave_local_minimum(Walk& walk, size_t iv, const Vec3& p) {
  double highest = -std::numeric_limits<double>::infinity();
  uint32_t face = 0;
  const auto& faces = walk.side[1 - iv].model->faces;
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const double h = faces[f].normal.dot(p) - faces[f].offset;
    if (h > highest) {
      highest = h;
      face = f;
    }
  }
  if (!(highest >= -walk.touching)) return Move::penetrating;
  walk.at[1 - iv] = {FeatureKind::face, face};
  return Move::onward;
}

}  // namespace

Move vertex_vertex(Walk& walk) {
  const Side &A = walk.side[0], &B = walk.side[1];
  const uint32_t ia = walk.at[0].index, ib = walk.at[1].index;
  const Vec3& a = A.model->vertices[ia];
  const Vec3 b = B.to_other(B.model->vertices[ib]);
  const Vec3 r = b - a;
  const WorstSpoke from_a = worst_spoke(*A.model, ia, r);
  if (from_a.excess > walk.epsilon) {
    walk.at[0] = edge(from_a.spoke->edge);
    return Move::onward;
  }
  const WorstSpoke from_b = worst_spoke(*B.model, ib, A.turn(-r));
  if (from_b.excess > walk.epsilon) {
    walk.at[1] = edge(from_b.spoke->edge);
    return Move::onward;
  }
  return answer_of_points(walk, 0, 0, a, b, r, std::max(from_a.excess, from_b.excess));
}

Move vertex_edge(Walk& walk, size_t iv) {
  const Side &V = walk.side[iv], &E = walk.side[1 - iv];
  const uint32_t v = walk.at[iv].index;
  PolyhedronFeature& y = walk.at[1 - iv];
  const VoronoiEdge& e = E.model->edges[y.index];
  const Vec3 p = V.to_other(V.model->vertices[v]);
  const Vec3 q = p - e.tail;
  const double s = e.direction.dot(q);
  if (s < -walk.epsilon || s > e.length + walk.epsilon) {
    y = vertex(e.vertices[s > 0]);
    return Move::onward;
  }
  const double over[2] = {e.into_face[0].dot(q), e.into_face[1].dot(q)};
  const double highest = std::max(over[0], over[1]);
  if (highest > walk.epsilon) {
    y = {FeatureKind::face, e.faces[over[1] > over[0]]};
    return Move::onward;
  }
  // From v to e, projected to be perpendicular to e once more, since |q| may be much longer.
  Vec3 r = s * e.direction - q;
  r -= e.direction.dot(r) * e.direction;
  const WorstSpoke worst = worst_spoke(*V.model, v, E.turn(r));
  if (worst.excess > walk.epsilon) {
    walk.at[iv] = edge(edge_beyond(walk, iv, v, e, s / e.length, worst.spoke->edge));
    return Move::onward;
  }
  const Vec3 nearest = e.tail + std::clamp(s, 0.0, e.length) * e.direction;
  return answer_of_points(walk, 1 - iv, iv, p, nearest, r, std::max(highest, worst.excess));
}

Move vertex_face(Walk& walk, size_t iv) {
  const Side &V = walk.side[iv], &F = walk.side[1 - iv];
  const uint32_t v = walk.at[iv].index;
  const VoronoiFace& f = F.model->faces[walk.at[1 - iv].index];
  const Vec3 p = V.to_other(V.model->vertices[v]);
  double outside = walk.epsilon;
  const VoronoiSide* leave = nullptr;
  for (const VoronoiSide& s : F.model->sides_of(f)) {
    const double d = s.offset - s.inward.dot(p);
    if (d > outside) {
      outside = d;
      leave = &s;
    }
  }
  if (leave) {
    walk.at[1 - iv] = edge(leave->edge);
    return Move::onward;
  }
  const double height = f.normal.dot(p) - f.offset;
  const double upright = height < -walk.touching ? -1 : 1;
  // Within the tolerance of the face only an edge that goes well below it counts as descending.
  const double least = std::abs(height) <= walk.touching ? height + walk.touching : walk.epsilon;
  const Vec3 down = F.turn(f.normal) * -upright;
  const VoronoiSpoke* steepest = nullptr;
  double most = least, descent = 0;
  for (const VoronoiSpoke& s : V.model->spokes_of(v)) {
    const double d = down.dot(s.direction) * s.length;
    descent = std::max(descent, d);
    if (d > most) {
      most = d;
      steepest = &s;
    }
  }
  if (steepest) {
    walk.at[iv] = edge(steepest->edge);
    return Move::onward;
  }
  if (upright < 0) return leave_local_minimum(walk, iv, p);
  Answer& found = walk.found;
  found.frame = 1 - iv;
  found.points[iv] = p;
  found.points[1 - iv] = p - height * f.normal;
  found.normal = iv == 1 ? f.normal : Vec3(-f.normal);
  found.distance = std::max(height, 0.0);
  found.overshoot = descent;
  return Move::arrived;
}

}  // namespace tumble::vclip
