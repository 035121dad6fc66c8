// References: distances of polyhedra by brute force over all pairs of triangles (closed-form
// closest points), closed forms for balls and capsules; depth of polyhedra by brute force over all
// face normals and edge cross products of both.
#include "engine/collision/gjk/epa.hpp"
#include "engine/collision/shapes/convex_hull.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

const ConvexHullShape& as_hull(const std::shared_ptr<const Shape>& s) {
  return static_cast<const ConvexHullShape&>(*s);
}

double brute_distance(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb) {
  const TriangleMesh ma =
      transformed(to_mesh(static_cast<const ConvexHullShape&>(a).polyhedron()), pa);
  const TriangleMesh mb =
      transformed(to_mesh(static_cast<const ConvexHullShape&>(b).polyhedron()), pb);
  double best = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < ma.triangles.size(); ++i)
    for (size_t j = 0; j < mb.triangles.size(); ++j)
      best = std::min(best,
                      closest_triangle_triangle({ma.corner(i, 0), ma.corner(i, 1), ma.corner(i, 2)},
                                                {mb.corner(j, 0), mb.corner(j, 1), mb.corner(j, 2)})
                          .squared_distance);
  return std::sqrt(best);
}

double width(const PlacedCore& A, const PlacedCore& B, const Vec3& n) {
  return n.dot(A.support(n)) - n.dot(B.support(-n));
}

double brute_depth(const ConvexHullShape& a, const PlacedCore& A, const ConvexHullShape& b,
                   const PlacedCore& B) {
  double best = std::numeric_limits<double>::infinity();
  const auto axis = [&](Vec3 n) {
    const double length = n.norm();
    if (length < 1e-9) return;
    n /= length;
    best = std::min({best, width(A, B, n), width(A, B, -n)});
  };
  for (const Plane& p : a.polyhedron().planes) axis(A.R * p.normal);
  for (const Plane& p : b.polyhedron().planes) axis(B.R * p.normal);
  const auto edge = [](const ConvexPolyhedron& p, const PolyhedronEdge& e) -> Vec3 {
    return (p.vertices[e.vertices[1]] - p.vertices[e.vertices[0]]).normalized();
  };
  for (const auto& e : a.polyhedron().edges)
    for (const auto& f : b.polyhedron().edges)
      axis((A.R * edge(a.polyhedron(), e)).cross(B.R * edge(b.polyhedron(), f)));
  return best;
}

PlacedCore place(const std::shared_ptr<const Shape>& s, const Pose& p) {
  return {*s->convex(), p.q, p.x};
}

}  // namespace

TEST_CASE("GJK finds the distance of polyhedra, needles and slabs among them") {
  Random r(51);
  int apart = 0;
  const int n = cases(600);
  for (int i = 0; i < n; ++i) {
    const double thin = i % 3 == 0 ? 1 : i % 3 == 1 ? 1e-2 : 1e-4;
    const Vec3 needle(1, thin, thin), slab(1, thin, 1);
    const auto a = random_hull(r, 8 + int(r.below(20)), i % 2 ? needle : slab),
               b = random_hull(r, 8 + int(r.below(20)), i % 4 < 2 ? needle : slab);
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    const Pose pb{pa.x + random_direction(r) * r.uniform(0.2, 2.2), random_rotation(r)};
    const GjkResult g = gjk(place(a, pa), place(b, pb));
    CHECK(g.converged());
    const double exact = brute_distance(*a, pa, *b, pb);
    if (g.status == GjkStatus::intersecting) {
      CHECK(exact < 1e-9);  // surfaces of solids this thin cross when the solids do
      continue;
    }
    ++apart;
    CHECK(std::abs(g.distance - exact) < 1e-9);
    CHECK(g.lower_bound <= g.distance);
    CHECK(g.distance - g.lower_bound < 1e-9);
    CHECK(std::abs((g.b - g.a).norm() - g.distance) < 1e-9);
    CHECK(g.iterations < 60);
  }
  if (n >= 100) CHECK((apart > 0.3 * n && apart < n));
}

TEST_CASE("GJK at chosen gaps: touching, a nanometre, far away, far from the origin") {
  Random r(52);
  for (int i = 0; i < cases(400); ++i) {
    const auto a = box({1, 0.5, 0.75}), b = box({0.3, 0.3, 0.3});
    const double offset = i % 2 ? 0 : 1e4;
    const Vec3 origin = random_direction(r) * offset;
    for (double gap : {0.0, 1e-12, 1e-9, 1e-6, 1e-3, 1.0, 1e4}) {
      const Pose pa{origin, random_rotation(r)};
      const Vec3 n = pa.direction(Vec3::UnitY());
      const Pose pb{origin + (0.8 + gap) * n + 0.2 * pa.direction(Vec3::UnitX()), pa.q};
      GjkResult g = gjk(place(a, {Vec3::Zero(), pa.q}), place(b, {pb.x - pa.x, pb.q}));
      CHECK(std::abs(g.distance - gap) <= 1e-9 * (1 + gap) + (offset > 0 ? 1e-11 : 0));
      if (gap >= 1e-6) CHECK((g.normal - n).norm() < 1e-4);
      CHECK(g.converged());
      GjkOptions options;
      options.max_distance = 0.5;
      g = gjk(place(a, {Vec3::Zero(), pa.q}), place(b, {pb.x - pa.x, pb.q}), options);
      CHECK((g.status == GjkStatus::beyond) == (gap > 0.5));
    }
  }
}

TEST_CASE("EPA finds the depth of polyhedra") {
  Random r(53);
  int overlapping = 0;
  const int n = cases(300);
  for (int i = 0; i < n; ++i) {
    const Vec3 axes(1, i % 3 ? 0.7 : 0.05, i % 2 ? 0.8 : 0.3);
    const auto a = random_hull(r, 6 + int(r.below(16)), axes),
               b = random_hull(r, 6 + int(r.below(16)), axes);
    const Pose pa{Vec3::Zero(), random_rotation(r)};
    const Pose pb{random_direction(r) * r.uniform(0, 1.2), random_rotation(r)};
    const PlacedCore A = place(a, pa), B = place(b, pb);
    const GjkResult g = gjk(A, B);
    if (g.status != GjkStatus::intersecting) continue;
    ++overlapping;
    const EpaResult e = epa(A, B, g.simplex);
    const double exact = brute_depth(as_hull(a), A, as_hull(b), B);
    CHECK(e.depth == doctest::Approx(width(A, B, e.normal)));  // the move separates
    CHECK(e.depth >= exact - 1e-9);
    CHECK(e.depth <= exact + 1e-7);
    CHECK(e.lower_bound <= exact + 1e-9);
    CHECK(e.converged);
  }
  if (n >= 100) CHECK((overlapping > 0.2 * n && overlapping < n));
}

TEST_CASE("EPA where things touch, coincide or are flat") {
  Random r(54);
  const auto a = box({1, 0.5, 0.75}), b = box({0.3, 0.3, 0.3});
  for (int i = 0; i < cases(200); ++i) {
    const Quat q = random_rotation(r);
    const Pose pa{Vec3::Zero(), q};
    for (double depth : {0.0, 1e-13, 1e-10, 1e-6, 0.05}) {
      const Pose pb{q * (Vec3(0.1, 0.8 - depth, 0.05)), q};
      const PlacedCore A = place(a, pa), B = place(b, pb);
      const GjkResult g = gjk(A, B);
      if (g.status != GjkStatus::intersecting) {
        CHECK(depth < 1e-9);
        continue;
      }
      const EpaResult e = epa(A, B, g.simplex);
      CHECK(std::abs(e.depth - depth) < 1e-9);
      CHECK(e.normal.allFinite());
      if (depth > 1e-9) CHECK((e.normal - q * Vec3::UnitY()).norm() < 1e-5);
    }
    // coincident
    const PlacedCore A = place(a, pa);
    const EpaResult e = epa(A, A, gjk(A, A).simplex);
    CHECK(e.depth == doctest::Approx(1.0));
    CHECK(std::abs(std::abs(e.normal.dot(q * Vec3::UnitY())) - 1) < 1e-6);
  }
}

TEST_CASE("a cylinder's depth in a box has the closed form along its axis and across") {
  const auto can = cylinder(0.5, 1), slab = box({5, 1, 5});
  for (double depth : {1e-6, 1e-3, 0.1}) {
    const PlacedCore A = place(slab, {{0, -1, 0}, Quat::Identity()});
    PlacedCore B = place(can, {{0.3, 0.5 - depth, 0.2}, Quat::Identity()});
    EpaResult e = epa(A, B, gjk(A, B).simplex);
    CHECK(std::abs(e.depth - depth) < 1e-8);
    B = place(can, {{0.3, 0.5 - depth, 0.2}, axis_angle(Vec3(1, 0, 0.3), det::pi / 2)});
    e = epa(A, B, gjk(A, B).simplex);
    CHECK(std::abs(e.depth - depth) < 1e-4 * depth + 1e-8);
  }
}
