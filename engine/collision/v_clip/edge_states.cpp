// The states of V-Clip with an edge against an edge or a face.
#include "engine/collision/v_clip/clip_edge.hpp"
#include "engine/collision/v_clip/walk.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::vclip {
namespace {

/// An edge in the other body's frame.
struct Line {
  Vec3 tail, direction;
  double length;
};

Line to_other(const Side& side, const VoronoiEdge& e) {
  return {side.to_other(e.tail), side.turn(e.direction), e.length};
}

PolyhedronFeature face(uint32_t i) {
  return {FeatureKind::face, i};
}

/// The greatest slope [m over |r|] into the faces of both edges, for r from the first to the
/// second, in frame 0 and perpendicular to both.
double slope_into_faces(const Walk& walk, const VoronoiEdge& e0, const VoronoiEdge& e1,
                        const Vec3& r) {
  const Vec3 back = walk.side[0].turn(-r);
  return std::max({e0.into_face[0].dot(r), e0.into_face[1].dot(r), e1.into_face[0].dot(back),
                   e1.into_face[1].dot(back)});
}

Move write_edge_answer(Walk& walk, const Vec3& a, const Vec3& b, const Vec3& r, double excess) {
  Answer& found = walk.found;
  found.frame = 0;
  found.points = {a, b};
  found.distance = r.norm();
  const double inverse = found.distance > 0 ? 1 / found.distance : 0;
  found.normal = r * inverse;
  found.overshoot = excess > 0 ? excess * inverse * walk.reach : 0;
  return Move::arrived;
}

/// The usual case: skew lines whose nearest points are inside both edges and both regions. Gives
/// the result of the clipping and the derivatives directly.
bool cross_between_ends(Walk& walk, const VoronoiEdge& e0, const VoronoiEdge& e1,
                        const Line& line) {
  const Vec3 w = line.tail - e0.tail;
  const double c = e0.direction.dot(line.direction), sine2 = 1 - c * c;
  if (sine2 < 1e-4) return false;
  const double inverse = 1 / sine2;
  const double a = w.dot(e0.direction), b = w.dot(line.direction);
  const double s = (a - c * b) * inverse, t = (c * a - b) * inverse;
  if (!(s >= 0 && s <= e0.length && t >= 0 && t <= e1.length)) return false;
  Vec3 r = w + t * line.direction - s * e0.direction;
  // Once more, so that r is perpendicular to both even if it is far shorter than w.
  const double a2 = r.dot(e0.direction), b2 = r.dot(line.direction);
  r += ((c * a2 - b2) * inverse) * line.direction - ((a2 - c * b2) * inverse) * e0.direction;
  const double excess = slope_into_faces(walk, e0, e1, r);
  if (excess > walk.epsilon) return false;
  write_edge_answer(walk, e0.tail + s * e0.direction, line.tail + t * line.direction, r, excess);
  return true;
}

/// The published test of one edge's region: the line (the other edge, in this edge's frame) is
/// clipped by the VE planes, then by the FE planes, and the derivative of its distance where it
/// enters or leaves says behind which plane its nearest point lies. Writes the neighbour to go to.
bool leaves_vertex_planes(const Walk& walk, const VoronoiEdge& e, const Line& line,
                          PolyhedronFeature& neighbour) {
  const double tail = e.direction.dot(line.tail - e.tail) + walk.epsilon;
  const double step = e.direction.dot(line.direction) * line.length;
  const double room = e.length + 2 * walk.epsilon;
  ClippedEdge clipped;
  if (clipped.cut(tail, tail + step, 0)) clipped.cut(room - tail, room - tail - step, 1);
  const auto go = [&](uint32_t end) {
    neighbour = {FeatureKind::vertex, e.vertices[end]};
    return true;
  };
  if (clipped.simply_excluded) return go(clipped.min_neighbour);
  const auto slope = [&](double lambda, uint32_t end) {
    const Vec3 v = e.tail + (end ? e.length : 0.0) * e.direction;
    return line.direction.dot(line.tail - v) + lambda * line.length;
  };
  const uint32_t low = clipped.min_neighbour, high = clipped.max_neighbour;
  if (low != ClippedEdge::none && slope(clipped.min, low) > walk.epsilon) return go(low);
  if (high != ClippedEdge::none && slope(clipped.max, high) < -walk.epsilon) return go(high);
  return false;
}

bool leaves_face_planes(const Walk& walk, size_t ie, const VoronoiEdge& e, const Line& line,
                        PolyhedronFeature& neighbour) {
  ClippedEdge clipped;
  const Vec3 w = line.tail - e.tail;
  for (uint32_t k = 0; k < 2; ++k) {
    const double tail = walk.epsilon - e.into_face[k].dot(w);
    const double head = tail - e.into_face[k].dot(line.direction) * line.length;
    if (!clipped.cut(tail, head, k)) break;
  }
  const auto go = [&](uint32_t k) {
    neighbour = face(e.faces[k]);
    return true;
  };
  if (clipped.simply_excluded) return go(clipped.min_neighbour);
  const auto normal = [&](uint32_t k) -> const Vec3& {
    return walk.side[ie].model->faces[e.faces[k]].normal;
  };
  const auto height = [&](double lambda, uint32_t k) {
    return normal(k).dot(w) + lambda * (normal(k).dot(line.direction) * line.length);
  };
  const auto slope = [&](double lambda, uint32_t k) {
    const double h = height(lambda, k), rise = normal(k).dot(line.direction) * line.length;
    if (std::abs(h) <= walk.touching) return 0.0;  // on the edge's own line
    return h > 0 ? rise : -rise;
  };
  const uint32_t low = clipped.min_neighbour, high = clipped.max_neighbour;
  if (low != ClippedEdge::none && slope(clipped.min, low) > walk.epsilon) return go(low);
  if (high != ClippedEdge::none && slope(clipped.max, high) < -walk.epsilon) return go(high);
  // Outside one plane or the other everywhere: there is no slope to choose by, unless the line
  // passes through the edge itself.
  if (clipped.min > clipped.max && std::abs(height(clipped.min, low)) > walk.touching)
    return go(low);
  return false;
}

/// Result for parallel edges, or for nearest points at ends that the tests left undecided.
Move answer_by_segments(Walk& walk, const VoronoiEdge& e0, const VoronoiEdge& e1,
                        const Line& line) {
  const SegmentsNearest near =
      nearest_of_segments(e0.tail, e0.direction, e0.length, line.tail, line.direction, line.length);
  Vec3 r = near.gap;
  const double slope0 = e0.direction.dot(r);
  r -= slope0 * e0.direction;
  const double slope1 = std::abs(line.direction.dot(r));
  const double excess = std::max(slope_into_faces(walk, e0, e1, r), slope1);
  const Vec3 a = e0.tail + near.s * e0.direction, b = line.tail + near.t * line.direction;
  write_edge_answer(walk, a, b, r, excess);
  walk.found.distance = near.gap.norm();
  walk.found.overshoot += std::abs(slope0) > walk.epsilon ? walk.reach : 0;
  return Move::arrived;
}

/// The edge or corner of f nearest to a line that does not cross f.
PolyhedronFeature nearest_on_outline(const Walk& walk, const VoronoiPolyhedron& model,
                                     const VoronoiFace& f, const Line& line) {
  double least = std::numeric_limits<double>::infinity();
  PolyhedronFeature nearest;
  for (const VoronoiSide& side : model.sides_of(f)) {
    const VoronoiEdge& e = model.edges[side.edge];
    const SegmentsNearest near =
        nearest_of_segments(e.tail, e.direction, e.length, line.tail, line.direction, line.length);
    const double d = near.gap.squaredNorm();
    if (!(d < least)) continue;
    least = d;
    nearest = {FeatureKind::edge, side.edge};
    if (near.s <= walk.epsilon) nearest = {FeatureKind::vertex, e.vertices[0]};
    if (near.s >= e.length - walk.epsilon) nearest = {FeatureKind::vertex, e.vertices[1]};
  }
  return nearest;
}

}  // namespace

Move edge_edge(Walk& walk) {
  const Side &A = walk.side[0], &B = walk.side[1];
  const VoronoiEdge& e0 = A.model->edges[walk.at[0].index];
  const VoronoiEdge& e1 = B.model->edges[walk.at[1].index];
  const Line line1 = to_other(B, e1);
  if (cross_between_ends(walk, e0, e1, line1)) return Move::arrived;
  PolyhedronFeature next;
  if (leaves_vertex_planes(walk, e0, line1, next) || leaves_face_planes(walk, 0, e0, line1, next)) {
    walk.at[0] = next;
    return Move::onward;
  }
  const Line line0 = to_other(A, e0);
  if (leaves_vertex_planes(walk, e1, line0, next) || leaves_face_planes(walk, 1, e1, line0, next)) {
    walk.at[1] = next;
    return Move::onward;
  }
  return answer_by_segments(walk, e0, e1, line1);
}

Move edge_face(Walk& walk, size_t ie) {
  const Side &E = walk.side[ie], &F = walk.side[1 - ie];
  const VoronoiEdge& e = E.model->edges[walk.at[ie].index];
  const VoronoiFace& f = F.model->faces[walk.at[1 - ie].index];
  const Line line = to_other(E, e);
  const Vec3 head = line.tail + line.length * line.direction;
  ClippedEdge clipped;
  for (const VoronoiSide& s : F.model->sides_of(f)) {
    const double offset = s.offset - walk.epsilon;
    if (!clipped.cut(s.inward.dot(line.tail) - offset, s.inward.dot(head) - offset, s.edge)) {
      walk.at[1 - ie] = nearest_on_outline(walk, *F.model, f, line);
      return Move::onward;
    }
  }
  const double from = f.normal.dot(line.tail) - f.offset;
  const double rise = f.normal.dot(line.direction) * line.length;
  const double h0 = from + clipped.min * rise, h1 = from + clipped.max * rise;
  const double low = std::min(h0, h1), high = std::max(h0, h1), touch = walk.touching;
  if (low < -touch && high >= -touch) return Move::penetrating;
  // The sign of the derivative of the distance along e: towards its nearer end.
  const bool tail_nearer = low < -touch ? rise <= 0 : rise >= 0;
  const uint32_t side = tail_nearer ? clipped.min_neighbour : clipped.max_neighbour;
  if (side != ClippedEdge::none) {
    walk.at[1 - ie] = {FeatureKind::edge, side};
  } else {
    walk.at[ie] = {FeatureKind::vertex, e.vertices[tail_nearer ? 0 : 1]};
  }
  return Move::onward;
}

}  // namespace tumble::vclip
