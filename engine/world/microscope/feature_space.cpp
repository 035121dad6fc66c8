#include "engine/world/microscope/feature_space.hpp"

#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/shapes/convex_shape.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The convex hull of the corners of a feature.
class FeatureCore final : public ConvexCore {
 public:
  explicit FeatureCore(std::vector<Vec3> corners)
      : ConvexCore(CoreView::of_reach(reach(corners), corners.front())),
        corners_(std::move(corners)) {}
  Vec3 support(const Vec3& d) const override {
    const auto less = [&](const Vec3& p, const Vec3& q) { return d.dot(p) < d.dot(q); };
    return *std::max_element(corners_.begin(), corners_.end(), less);
  }
  void supporting_face(const Vec3& d, SupportingFace& face) const override {
    face.count = 0;
    face.add(support(d), 0);
  }

 private:
  static double reach(const std::vector<Vec3>& corners) {
    double r = 0;
    for (const Vec3& p : corners) r = std::max(r, p.norm());
    return r;
  }
  std::vector<Vec3> corners_;
};

const VoronoiPolyhedron& voronoi_of(const Specimen& s) {
  return *s.shape->convex()->voronoi();
}

}  // namespace

FeatureSpace::FeatureSpace(const MicroscopeSlide& slide)
    : slide_(slide),
      placed_{
          PlacedPolyhedron(voronoi_of(slide.body[0]), Pose{Vec3::Zero(), slide.body[0].pose().q}),
          PlacedPolyhedron(
              voronoi_of(slide.body[1]),
              Pose{slide.body[1].pose().x - slide.body[0].pose().x, slide.body[1].pose().q})},
      origin_(slide.body[0].pose().x) {}

Vec3 FeatureSpace::point(size_t body, const Vec3& p) const {
  return origin_ + placed_[body].x + placed_[body].R * p;
}

std::vector<Vec3> FeatureSpace::corners(const PolyhedronFeature& f, size_t body) const {
  const VoronoiPolyhedron& model = *placed_[body].model;
  std::vector<Vec3> out;
  if (f.kind == FeatureKind::vertex) {
    out.push_back(point(body, model.vertices[f.index]));
  } else if (f.kind == FeatureKind::edge) {
    for (const uint32_t v : model.edges[f.index].vertices)
      out.push_back(point(body, model.vertices[v]));
  } else {
    // Sides run counter-clockwise: each begins at the end of the previous one.
    const auto sides = model.sides_of(model.faces[f.index]);
    for (size_t i = 0; i < sides.size(); ++i) {
      const auto& ends = model.edges[sides[i].edge].vertices;
      const auto& next = model.edges[sides[(i + 1) % sides.size()].edge].vertices;
      const bool second = ends[1] == next[0] || ends[1] == next[1];
      out.push_back(point(body, model.vertices[ends[second ? 1 : 0]]));
    }
  }
  return out;
}

FeatureSpace::Nearest FeatureSpace::nearest(const ClosestFeatures& at) const {
  std::vector<Vec3> pa = corners(at[0], 0), pb = corners(at[1], 1);
  for (Vec3& p : pa) p -= origin_;
  for (Vec3& p : pb) p -= origin_;
  const FeatureCore a(std::move(pa)), b(std::move(pb));
  const GjkResult g = gjk(PlacedCore(a, Quat::Identity(), Vec3::Zero()),
                          PlacedCore(b, Quat::Identity(), Vec3::Zero()));
  return {from_query(g.a), from_query(g.b), g.distance};
}

void FeatureSpace::draw(Sketch& out) const {
  for (size_t i = 0; i < 2; ++i) {
    const Specimen& s = slide_.body[i];
    out.ghosts.push_back({i, s.pose(), 0.45f, true});
    out.label(s.shape->bounds(s.pose()).centre(), i == 0 ? "A" : "B", Ink::plain);
  }
}

void FeatureSpace::draw_features(Sketch& out, const ClosestFeatures& at) const {
  for (size_t i = 0; i < 2; ++i) {
    const std::vector<Vec3> p = corners(at[i], i);
    if (p.size() == 1) out.point(p[0], Ink::active, 16);
    if (p.size() == 2) out.line(p[0], p[1], Ink::active, 6);
    if (p.size() > 2) {
      add_polygon(out, p, Ink::active, 0.6f);
      for (size_t k = 0; k < p.size(); ++k) out.line(p[k], p[(k + 1) % p.size()], Ink::active, 4);
    }
  }
  const Nearest n = nearest(at);
  out.line(n.a, n.b, Ink::answer, 3);
  out.point(n.a, Ink::answer, 10);
  out.point(n.b, Ink::answer, 10);
}

/// A vertex-edge plane: normal to the edge, through its end.
void FeatureSpace::draw_across(Sketch& out, uint32_t e, uint32_t v, size_t body) const {
  const VoronoiPolyhedron& model = *placed_[body].model;
  const Vec3 along = placed_[body].R * model.edges[e].direction;
  add_plane(out, point(body, model.vertices[v]), along, 0.8 * model.radius, Ink::test);
}

/// A face-edge plane: normal to the face, through the edge.
void FeatureSpace::draw_upright(Sketch& out, uint32_t e, uint32_t f, size_t body) const {
  const VoronoiPolyhedron& model = *placed_[body].model;
  const std::vector<Vec3> ends = corners({FeatureKind::edge, e}, body);
  const Vec3 up = placed_[body].R * model.faces[f].normal * (1.3 * model.radius);
  add_polygon(out, {ends[0], ends[1], ends[1] + up, ends[0] + up}, Ink::test, 0.28f);
}

void FeatureSpace::draw_crossed_plane(Sketch& out, const PolyhedronFeature& from,
                                      const PolyhedronFeature& to, size_t body) const {
  using enum FeatureKind;
  if (from.kind == vertex && to.kind == edge) return draw_across(out, to.index, from.index, body);
  if (from.kind == edge && to.kind == vertex) return draw_across(out, from.index, to.index, body);
  if (from.kind == edge && to.kind == face) return draw_upright(out, from.index, to.index, body);
  if (from.kind == face && to.kind == edge) return draw_upright(out, to.index, from.index, body);
  if (to.kind == face) add_polygon(out, corners(to, body), Ink::test, 0.4f);
  if (to.kind == vertex) out.point(corners(to, body)[0], Ink::test, 16);
}

}  // namespace tumble
