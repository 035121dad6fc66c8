// Features that meet: decides whether the bodies touch or overlap there.
#include "engine/collision/v_clip/walk.hpp"

#include <algorithm>

namespace tumble::vclip {
namespace {

/// The surroundings of a body's witness point, in frame 0: the adjacent corners, relative to the
/// point, the normals of the faces there and the directions of the edges.
struct Neighbourhood {
  std::vector<Vec3> corners, normals, edges;
};

void add_edge(const VoronoiPolyhedron& model, uint32_t e, Neighbourhood& n) {
  const VoronoiEdge& edge = model.edges[e];
  n.edges.push_back(edge.direction);
  for (uint32_t f : edge.faces) n.normals.push_back(model.faces[f].normal);
}

/// In the body's own frame, about `point` there.
Neighbourhood around(const VoronoiPolyhedron& model, const PolyhedronFeature& x,
                     const Vec3& point) {
  Neighbourhood n;
  if (x.kind == FeatureKind::vertex) {
    for (const VoronoiSpoke& s : model.spokes_of(x.index)) {
      n.corners.push_back(model.vertices[s.other] - point);
      add_edge(model, s.edge, n);
    }
    return n;
  }
  add_edge(model, x.index, n);
  for (uint32_t f : model.edges[x.index].faces) {
    for (const VoronoiSide& s : model.sides_of(model.faces[f])) {
      for (uint32_t v : model.edges[s.edge].vertices)
        n.corners.push_back(model.vertices[v] - point);
    }
  }
  return n;
}

/// By how much the two extend beyond the plane with normal `n` through the contact.
double overlap_across(const Neighbourhood& a, const Neighbourhood& b, const Vec3& n) {
  double most = 0;
  for (const Vec3& c : a.corners) most = std::max(most, n.dot(c));
  for (const Vec3& c : b.corners) most = std::max(most, -n.dot(c));
  return most;
}

}  // namespace

Move judge_touching(Walk& walk) {
  const Side &A = walk.side[0], &B = walk.side[1];
  Answer& found = walk.found;
  Vec3 pa = found.points[0], pb = found.points[1];
  (found.frame == 0 ? pb : pa) = (found.frame == 0 ? A : B).to_other(found.frame == 0 ? pb : pa);
  const Neighbourhood a = around(*A.model, walk.at[0], pa);
  Neighbourhood b = around(*B.model, walk.at[1], pb);
  for (auto* list : {&b.corners, &b.normals, &b.edges})
    for (Vec3& d : *list) d = B.turn(d);
  // Two cones that can be separated are separated by a face of one or by a plane along an edge of
  // each.
  double least = std::numeric_limits<double>::infinity();
  const auto offer = [&](const Vec3& n) {
    const double overlap = overlap_across(a, b, n);
    if (overlap >= least) return;
    least = overlap;
    found.normal = found.frame == 0 ? n : B.R.transpose() * n;
  };
  for (const Vec3& n : a.normals) offer(n);
  for (const Vec3& n : b.normals) offer(-n);
  if (least > walk.touching && a.edges.size() * b.edges.size() > 1024) return search_all(walk);
  for (size_t i = 0; i < a.edges.size() && least > walk.touching; ++i) {
    for (const Vec3& e : b.edges) {
      const Vec3 n = a.edges[i].cross(e);
      const double length = n.norm();
      if (length < 1e-9) continue;
      offer(n / length);
      offer(-n / length);
    }
  }
  return least <= 2 * walk.touching ? Move::arrived : Move::penetrating;
}

}  // namespace tumble::vclip
