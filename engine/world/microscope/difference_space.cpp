#include "engine/world/microscope/difference_space.hpp"

#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {
namespace {

/// Differences of at most so many vertices are drawn exactly,
constexpr size_t most_points = 6000;
/// others through support points in so many directions.
constexpr int directions = 480;

const ConvexCore& core_of(const Specimen& s) {
  return *s.shape->convex();
}

/// Distinct vertices of a core; empty if it is curved.
std::vector<Vec3> core_vertices(const ConvexCore& core) {
  const CoreView& view = core.view();
  std::vector<Vec3> out;
  if (view.kind == CoreView::Kind::box) {
    for (int i = 0; i < 8; ++i)
      out.push_back(view.half.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  } else if (view.kind == CoreView::Kind::vertices) {
    for (uint32_t i = 0; i < view.vertices.padded; ++i) out.push_back(view.vertices[i].vec());
  }
  return out;
}

/// The k-th of n directions spread evenly over the sphere.
Vec3 spread_direction(int k, int n) {
  const double y = 1 - (2 * k + 1.0) / n, r = std::sqrt(1 - y * y);
  const double turn = k * 2.399963229728653;
  return {r * det::cos(turn), y, r * det::sin(turn)};
}

}  // namespace

DifferenceSpace::DifferenceSpace(const MicroscopeSlide& slide)
    : slide_(slide), beside_(slide.beside) {
  const Pose pa = slide.body[0].pose(), pb = slide.body[1].pose();
  origin_ = pa.x;
  A_ = PlacedCore(core_of(slide.body[0]), pa.q, Vec3::Zero());
  B_ = PlacedCore(core_of(slide.body[1]), pb.q, pb.x - pa.x);
  size_ = 0.5 * (slide.body[0].shape->bounding_radius() + slide.body[1].shape->bounding_radius());
  make_outline();
}

DifferencePoint DifferenceSpace::support(const Vec3& d) const {
  return Difference(A_, B_).support(Plain3::of(d));
}

void DifferenceSpace::make_outline() {
  const std::vector<Vec3> a = core_vertices(*A_.core), b = core_vertices(*B_.core);
  std::vector<Vec3> points;
  const bool exact = !a.empty() && !b.empty() && a.size() * b.size() <= most_points;
  if (exact) {
    for (const Vec3& p : a)
      for (const Vec3& q : b) points.push_back(beside_ + A_.R * p - (B_.x + B_.R * q));
  } else {
    for (int k = 0; k < directions; ++k)
      points.push_back(beside(support(spread_direction(k, directions)).w.vec()));
  }
  const auto hull = convex_hull(points);
  if (!hull) return;  // two points or segments have no volume to outline
  const ConvexPolyhedron& polyhedron = hull->polyhedron;
  Sketch::Surface surface{{}, Ink::faint, 0.16f};
  const TriangleMesh mesh = to_mesh(polyhedron);
  for (const Triangle& t : mesh.triangles)
    surface.triangles.push_back({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]});
  outline_.surfaces.push_back(std::move(surface));
  if (!exact) return;
  for (const PolyhedronEdge& e : polyhedron.edges)
    outline_.line(polyhedron.vertices[e.vertices[0]], polyhedron.vertices[e.vertices[1]],
                  Ink::faint, 1);
}

void DifferenceSpace::draw(Sketch& out) const {
  out.ghosts.push_back({0, slide_.body[0].pose(), 0.4f, true});
  out.ghosts.push_back({1, slide_.body[1].pose(), 0.4f, true});
  out.surfaces.insert(out.surfaces.end(), outline_.surfaces.begin(), outline_.surfaces.end());
  out.lines.insert(out.lines.end(), outline_.lines.begin(), outline_.lines.end());
  const double arm = 0.2 * size_;
  for (int i = 0; i < 3; ++i)
    out.line(beside_ - arm * Vec3::Unit(i), beside_ + arm * Vec3::Unit(i), Ink::plain, 1.5f);
  out.point(beside_, Ink::plain, 10);
  out.label(beside_ - Vec3(0, 1.6 * arm, 0), "origin", Ink::plain);
  for (size_t i = 0; i < 2; ++i) {
    const Aabb bounds = slide_.body[i].shape->bounds(slide_.body[i].pose());
    const Vec3 top(bounds.centre().x(), bounds.max.y() + 0.25 * size_, bounds.centre().z());
    out.label(top, i == 0 ? "A" : "B", i == 0 ? Ink::first : Ink::second);
  }
  Aabb bounds;
  for (const Sketch::Surface& s : outline_.surfaces)
    for (const auto& t : s.triangles)
      for (const Vec3& p : t) bounds.include(p);
  if (!bounds.empty())
    out.label(Vec3(bounds.centre().x(), bounds.max.y() + 0.25 * size_, bounds.centre().z()),
              "A - B", Ink::plain);
}

}  // namespace tumble
