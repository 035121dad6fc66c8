#include "engine/collision/v_clip/separating_plane.hpp"

#include "engine/collision/gjk/epa.hpp"

#include <algorithm>

namespace tumble::vclip {
namespace {

class PolyhedronCore final : public ConvexCore {
 public:
  explicit PolyhedronCore(const VoronoiPolyhedron& model)
      : ConvexCore(CoreView::of_reach(model.centre.norm() + model.radius, model.centre)),
        model_(model) {}
  Vec3 support(const Vec3& direction) const override {
    const Vec3* best = &model_.vertices[0];
    double height = direction.dot(*best);
    for (const Vec3& v : model_.vertices) {
      const double h = direction.dot(v);
      if (h > height) {
        height = h;
        best = &v;
      }
    }
    return *best;
  }
  void supporting_face(const Vec3&, SupportingFace& face) const override { face.count = 0; }

 private:
  const VoronoiPolyhedron& model_;
};

struct Proposals {
  const Walk& walk;
  PartingDirection best;

  /// Whether the best direction so far separates the bodies or lets them touch.
  bool good() const { return best.gap >= -walk.touching; }
  void offer(const Vec3& n) {
    const double gap = gap_across(walk, n);
    if (gap > best.gap) best = {n, gap, 0};
  }
};

/// Offers the faces of both, and all pairs of edges whose arcs on the Gauss sphere cross: these are
/// all faces of the Minkowski difference (Gottschalk 1996; Gregorius 2013).
void offer_all(Proposals& p) {
  const Side &A = p.walk.side[0], &B = p.walk.side[1];
  for (const VoronoiFace& f : A.model->faces) p.offer(f.normal);
  for (const VoronoiFace& f : B.model->faces) p.offer(-B.turn(f.normal));
  std::vector<std::array<Vec3, 3>> arcs;  // direction of the edge and its faces' normals, opposed
  for (const VoronoiEdge& e : B.model->edges) {
    arcs.push_back({B.turn(e.direction), -B.turn(B.model->faces[e.faces[0]].normal),
                    -B.turn(B.model->faces[e.faces[1]].normal)});
  }
  constexpr double slack = 1e-9;  // arcs that meet at an end count
  for (const VoronoiEdge& e : A.model->edges) {
    const Vec3 &n0 = A.model->faces[e.faces[0]].normal, &n1 = A.model->faces[e.faces[1]].normal;
    for (const auto& [along, m0, m1] : arcs) {
      if (along.dot(n0) * along.dot(n1) > slack) continue;
      if (e.direction.dot(m0) * e.direction.dot(m1) > slack) continue;
      const Vec3 n = e.direction.cross(along);
      const double length = n.norm();
      if (length < 1e-12) continue;
      p.offer(n / length);
      p.offer(-n / length);
    }
  }
}

}  // namespace

double gap_across(const Walk& walk, const Vec3& normal) {
  double high = -std::numeric_limits<double>::infinity(), low = -high;
  for (const Vec3& v : walk.side[0].model->vertices) high = std::max(high, normal.dot(v));
  const Vec3 n_b = walk.side[0].turn(normal);
  for (const Vec3& v : walk.side[1].model->vertices) low = std::min(low, n_b.dot(v));
  return low + normal.dot(walk.side[1].t) - high;
}

PartingDirection parting_direction(const Walk& walk) {
  const PolyhedronCore core_a(*walk.side[0].model), core_b(*walk.side[1].model);
  PlacedCore A, B;
  A.core = &core_a;
  B.core = &core_b;
  B.R = walk.side[1].R;
  B.x = walk.side[1].t;
  Proposals proposals{walk, {}};
  const GjkResult g = gjk(A, B);
  if (g.status == GjkStatus::intersecting) {
    const EpaResult deep = epa(A, B, g.simplex);
    proposals.offer(deep.normal);
    const double depth = -proposals.best.gap;
    if (!proposals.good() && deep.converged && deep.lower_bound > 0.5 * depth)
      return proposals.best;
  } else {
    proposals.offer(g.normal);
  }
  if (!proposals.good()) offer_all(proposals);
  proposals.best.distance = std::max(g.distance, proposals.best.gap + 2 * walk.touching);
  return proposals.best;
}

}  // namespace tumble::vclip
