#pragma once
#include "engine/collision/v_clip/v_clip.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/math/rotation.hpp"
#include "tests/collision/support.hpp"
#include "tests/support/why_not.hpp"

/// Polyhedra and poses for the tests of V-Clip, awkward ones on purpose.
namespace tumble::test {

inline ConvexPolyhedron hull_of(const std::vector<Vec3>& points) {
  auto h = convex_hull(points);
  REQUIRE_MESSAGE(h.ok(), test::why_not(h));
  return std::move(h->polyhedron);
}

inline VoronoiPolyhedron voronoi(const ConvexPolyhedron& p) {
  auto v = make_voronoi_polyhedron(p);
  REQUIRE_MESSAGE(v.ok(), test::why_not(v));
  return *std::move(v);
}

inline VoronoiPolyhedron box_polyhedron(const Vec3& half) {
  std::vector<Vec3> points;
  for (unsigned k = 0; k < 8; ++k)
    points.push_back(half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1)));
  return voronoi(hull_of(points));
}

/// Upright prism with n sides, radius 1 and half height 0.5, scaled by `axes`.
inline VoronoiPolyhedron prism(int n, const Vec3& axes) {
  std::vector<Vec3> points;
  std::vector<std::vector<uint32_t>> loops(2);
  for (int i = 0; i < n; ++i) {
    const double angle = 2 * det::pi * i / n;
    for (double y : {-0.5, 0.5})
      points.push_back(axes.cwiseProduct(Vec3(det::cos(angle), y, det::sin(angle))));
    const auto k = uint32_t(2 * i), l = uint32_t(2 * ((i + 1) % n));
    loops[0].push_back(k);
    loops[1].insert(loops[1].begin(), k + 1);
    loops.push_back({k, k + 1, l + 1, l});
  }
  auto p = make_polyhedron(std::move(points), std::move(loops));
  REQUIRE(p.ok());
  return voronoi(*p);
}

inline VoronoiPolyhedron random_polyhedron(Random& r, int n, const Vec3& axes) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) points.push_back(random_direction(r).cwiseProduct(axes));
  return voronoi(hull_of(points));
}

inline ConvexPolyhedron lattice_hull(Random& r, int n) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) points.push_back(random_vec(r, -3, 3).array().round() / 4);
  for (int i = 0; i < 4; ++i) points.push_back(i ? Vec3::Unit(i - 1) : Vec3(-1, -1, -1));
  return hull_of(points);
}

/// Boxes, tetrahedra, prisms, random and lattice hulls, needles and slabs of 1:10^4.
inline std::vector<VoronoiPolyhedron> small_polyhedra(Random& r) {
  std::vector<VoronoiPolyhedron> out;
  for (const Vec3& h :
       {Vec3(0.5, 0.5, 0.5), Vec3(1, 0.5, 0.25), Vec3(1, 1e-4, 1e-4), Vec3(1, 1, 1e-4)})
    out.push_back(box_polyhedron(h));
  for (int n : {3, 4, 6, 12}) out.push_back(prism(n, {0.5, 1, 0.5}));
  out.push_back(prism(8, {1e-4, 2, 1e-4}));
  out.push_back(prism(5, {1, 1e-4, 1}));
  for (const Vec3& axes : {Vec3(1, 1, 1), Vec3(1, 0.7, 0.4), Vec3(1, 1e-4, 1e-4), Vec3(1, 1, 1e-4)})
    for (int n : {4, 7, 12}) out.push_back(random_polyhedron(r, n, axes));
  for (int i = 0; i < 4; ++i) out.push_back(voronoi(lattice_hull(r, 10)));
  return out;
}

/// A rotation by a multiple of 45 degrees about each axis, as exact as doubles can say it.
inline Quat lattice_rotation(Random& r) {
  Quat q = Quat::Identity();
  for (int axis = 0; axis < 3; ++axis)
    q = q * axis_angle(Vec3::Unit(axis), det::pi / 4 * double(r.below(8) * (r.below(3) ? 2 : 1)));
  return q.normalized();
}

inline double tiny(Random& r) {
  return std::pow(10.0, -r.uniform(3, 17)) * (r.below(2) ? 1 : -1);
}

enum class PoseFamily { random, near, deep, lattice, disturbed_lattice, coincident };
constexpr std::array all_pose_families{PoseFamily::random,
                                       PoseFamily::near,
                                       PoseFamily::deep,
                                       PoseFamily::lattice,
                                       PoseFamily::disturbed_lattice,
                                       PoseFamily::coincident};

/// Pose of B with A at the identity.
inline Pose draw_pose(Random& r, PoseFamily family, const VoronoiPolyhedron& a,
                      const VoronoiPolyhedron& b) {
  Pose p{Vec3::Zero(), random_rotation(r)};
  const auto quarter = [&](double range) -> Vec3 {
    return (4 * random_vec(r, -range, range)).array().round() / 4;
  };
  switch (family) {
    case PoseFamily::random:
      p.x = random_direction(r) * r.uniform(0, 3);
      break;
    case PoseFamily::near: {
      // Face on face or corner on face with a small gap.
      const VoronoiFace& f = a.faces[r.below(uint32_t(a.faces.size()))];
      const VoronoiFace& g = b.faces[r.below(uint32_t(b.faces.size()))];
      if (r.below(2)) p.q = rotation_between(g.normal, -f.normal);
      double low = std::numeric_limits<double>::infinity();
      for (const Vec3& v : b.vertices) low = std::min(low, f.normal.dot(p.direction(v)));
      const Vec3 side = f.normal.unitOrthogonal();
      p.x = f.normal * (f.offset - low + tiny(r)) + side * (r.below(2) ? r.uniform(-1, 1) : 0);
      break;
    }
    case PoseFamily::deep:
      p.x = random_direction(r) * r.uniform(0, 0.3) * std::min(a.radius, b.radius);
      break;
    case PoseFamily::lattice:
    case PoseFamily::disturbed_lattice:
      p = {quarter(2), lattice_rotation(r)};
      if (family == PoseFamily::lattice) break;
      p.x += tiny(r) * random_direction(r);
      if (r.below(2)) p.q = p.q * axis_angle(random_direction(r), tiny(r));
      break;
    case PoseFamily::coincident:
      p = {Vec3::Zero(), Quat::Identity()};
      if (r.below(2)) p.x = tiny(r) * random_direction(r);
      if (r.below(2)) p.q = axis_angle(random_direction(r), tiny(r));
      break;
  }
  return p;
}

/// Two polyhedra and their poses. The kinds of poses take turns with the number of the draw; every
/// third pair is moved as a whole.
struct DrawnPair {
  const VoronoiPolyhedron &a, &b;
  Pose pa, pb;
};
inline DrawnPair draw_pair(Random& r, const std::vector<VoronoiPolyhedron>& shapes, int number) {
  const PoseFamily family = all_pose_families[size_t(number) % all_pose_families.size()];
  const uint32_t ia = r.below(uint32_t(shapes.size())), ib = r.below(uint32_t(shapes.size()));
  const VoronoiPolyhedron &a = shapes[ia], &b = shapes[family == PoseFamily::coincident ? ia : ib];
  const Pose pb = draw_pose(r, family, a, b);
  if (number % 3) return {a, b, {}, pb};
  const Vec3 x = random_vec(r, -10, 10);
  const Pose pa{x, random_rotation(r)};
  return {a, b, pa, pa * pb};
}

inline PolyhedronFeature random_feature(Random& r, const VoronoiPolyhedron& p, bool face) {
  switch (r.below(face ? 3 : 2)) {
    case 0:
      return {FeatureKind::vertex, r.below(uint32_t(p.vertices.size()))};
    case 1:
      return {FeatureKind::edge, r.below(uint32_t(p.edges.size()))};
    default:
      return {FeatureKind::face, r.below(uint32_t(p.faces.size()))};
  }
}

inline ClosestFeatures random_features(Random& r, const VoronoiPolyhedron& a,
                                       const VoronoiPolyhedron& b) {
  const PolyhedronFeature f = random_feature(r, a, true);
  return {f, random_feature(r, b, f.kind != FeatureKind::face)};
}

inline double pair_scale(const VoronoiPolyhedron& a, const Pose& pa, const VoronoiPolyhedron& b,
                         const Pose& pb) {
  return 2 * a.radius + 2 * b.radius + (pb.point(b.centre) - pa.point(a.centre)).norm();
}

}  // namespace tumble::test
