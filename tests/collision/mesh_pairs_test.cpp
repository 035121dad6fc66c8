// References: the distance of two meshes by brute force over all pairs of triangles (closed-form
// closest points of triangles); boxes given as meshes against boxes; closed forms for thin plates
// and flat floors; the known direction and depth of a penetration made by pushing along the closest
// direction of a separated pose.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

#include <algorithm>
#include <limits>

using namespace tumble;
using namespace tumble::test;

namespace {

std::vector<Manifold> run(const Shape& a, const Pose& pa, const Shape& b, const Pose& pb,
                          double margin) {
  std::vector<Manifold> out;
  collide(a, pa, b, pb, margin, out);
  return out;
}

struct Deepest {
  double gap = std::numeric_limits<double>::infinity();
  Vec3 normal = Vec3::Zero();
  int points = 0;
};

Deepest deepest(const std::vector<Manifold>& list) {
  Deepest d;
  for (const Manifold& m : list) {
    CHECK(std::abs(m.normal.norm() - 1) < 1e-9);
    for (int i = 0; i < m.count; ++i) {
      ++d.points;
      CHECK(m.points[size_t(i)].x_world.allFinite());
      if (m.points[size_t(i)].gap < d.gap) d.gap = m.points[size_t(i)].gap, d.normal = m.normal;
    }
  }
  return d;
}

/// Brute force over all pairs of triangles.
TrianglePair distance(const TriangleMesh& a, const Pose& pa, const TriangleMesh& b,
                      const Pose& pb) {
  TrianglePair best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  const TriangleMesh wa = transformed(a, pa), wb = transformed(b, pb);
  for (size_t i = 0; i < wa.triangles.size(); ++i)
    for (size_t j = 0; j < wb.triangles.size(); ++j) {
      const Aabb x = triangle_bounds(wa, i), y = triangle_bounds(wb, j);
      if (!x.inflated(std::min(0.3, std::sqrt(best.squared_distance))).overlaps(y)) continue;
      const TrianglePair p =
          closest_triangle_triangle({wa.corner(i, 0), wa.corner(i, 1), wa.corner(i, 2)},
                                    {wb.corner(j, 0), wb.corner(j, 1), wb.corner(j, 2)});
      if (p.squared_distance < best.squared_distance) best = p;
    }
  return best;
}

/// Of a convex shape and a mesh by GJK with every triangle; the normal points to the mesh.
Deepest convex_distance(const ConvexShape& a, const Pose& pa, const Shape& m, const Pose& pb) {
  const TriangleMesh& mesh = *m.polyhedral()->surface().mesh;
  const PlacedCore A(a, pa.q, pa.x);
  Deepest best;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const TriangleCore triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    GjkOptions options;
    if (std::isfinite(best.gap)) options.max_distance = best.gap + a.rounding();
    const GjkResult g = gjk(A, PlacedCore(triangle, pb.q, pb.x), options);
    const double gap = (g.status == GjkStatus::intersecting ? 0 : g.distance) - a.rounding();
    if (g.status != GjkStatus::beyond && gap < best.gap) best = {gap, g.normal, 1};
  }
  return best;
}

}  // namespace

TEST_CASE("two tori: apart, the least gap is the distance, pushed together, depth and direction") {
  Random r(31);
  const TriangleMesh coarse = make_mesh::torus(0.5, 0.2, 24, 12);
  const TriangleMesh link = make_mesh::torus(0.5, 0.12, 32, 14);
  const int n = cases(100);
  int near = 0, lost = 0, pushed = 0, off = 0;
  for (int i = 0; i < n; ++i) {
    const TriangleMesh &ma = i % 2 ? coarse : link, &mb = i % 3 ? coarse : link;
    const auto a = mesh(ma), b = mesh(mb);
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    Pose pb{pa.x + random_direction(r) * r.uniform(0.2, 1.2), random_rotation(r)};
    // find a pose that is apart by a little: step towards or away along the closest direction
    TrianglePair d = distance(ma, pa, mb, pb);
    for (int k = 0; k < 6 && d.squared_distance > 0 && d.squared_distance < 1e9; ++k) {
      const double gap = std::sqrt(d.squared_distance);
      pb.x -= (d.on_b - d.on_a) / gap * (gap - 0.01);
      d = distance(ma, pa, mb, pb);
    }
    if (!(d.squared_distance > 0 && d.squared_distance < 0.018 * 0.018)) continue;
    ++near;
    const double gap = std::sqrt(d.squared_distance);
    const Vec3 n_exact = (d.on_b - d.on_a) / gap;
    const Deepest found = deepest(run(*a, pa, *b, pb, 0.02));
    CHECK(found.gap >= gap - 1e-9);
    if (found.gap > gap + 1e-3) ++lost;
    // Push in.
    const double limit = 0.5 * (ma.vertices.size() == link.vertices.size() ? 0.12 : 0.2);
    for (double depth : {1e-4, 2e-3, 0.02, 0.05, limit}) {
      const Pose deep{pb.x - n_exact * (gap + depth), pb.q};
      const auto list = run(*a, pa, *b, deep, 0.01);
      const Deepest in = deepest(list);
      ++pushed;
      // a way out: B moved by the deepest contacts, again and again, comes free near by
      Pose free = deep;
      int steps = 0;
      for (; steps < 40; ++steps) {
        const Deepest now = deepest(run(*a, pa, *b, free, 0.0));
        if (!(now.gap < -1e-6)) break;
        free.x -= now.normal * (now.gap - 1e-4);
      }
      const double moved = (free.x - deep.x).norm();
      const bool apart = distance(ma, pa, mb, free).squared_distance > 0 || depth < 1e-3;
      const bool good = in.gap < 0 && in.gap > -1.6 * depth - 1e-3 && steps < 40 &&
                        moved < 3 * depth + 0.01 && (apart || depth < 0.01);
      if (!good) {
        ++off;
      }
    }
  }
  if (n >= 50) CHECK(near > n / 5);
  CHECK(lost <= near / 10);
  CHECK(off <= pushed / 20);
}

TEST_CASE("boxes as meshes meet as boxes do") {
  Random r(32);
  int touching = 0, wrong = 0;
  const int n = std::max(200, cases(600));
  for (int i = 0; i < n; ++i) {
    const Vec3 ha = random_vec(r, 0.3, 1), hb = random_vec(r, 0.3, 1);
    const auto box_a = box(ha), box_b = box(hb);
    const auto a = mesh(make_mesh::box(ha)), b = mesh(make_mesh::box(hb));
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    const Vec3 d = random_direction(r);
    Pose pb{pa.x + 3 * d, random_rotation(r)};
    // bring them to a chosen depth by bisection along d
    const double wanted = i % 2 ? 0.01 : 0.05;
    double lo = 0, hi = 3;
    for (int k = 0; k < 40; ++k) {
      const double s = 0.5 * (lo + hi);
      pb.x = pa.x + s * d;
      (deepest(run(*box_a, pa, *box_b, pb, 0)).gap < -wanted ? lo : hi) = s;
    }
    const Deepest exact = deepest(run(*box_a, pa, *box_b, pb, 0));
    if (!(exact.gap < 0)) continue;
    ++touching;
    const Deepest meshes = deepest(run(*a, pa, *b, pb, 0));
    const Deepest mixed = deepest(run(*box_a, pa, *b, pb, 0));
    CHECK(mixed.gap == doctest::Approx(meshes.gap));
    const bool good = meshes.gap < 0 && meshes.gap > 1.5 * exact.gap - 1e-6 &&
                      meshes.gap < 0.3 * exact.gap && meshes.normal.dot(exact.normal) > 0.6;
    if (!good) {
      ++wrong;
    }
  }
  CHECK(touching > n / 2);
  CHECK(wrong <= touching / 20);
}

TEST_CASE("boxes resting, crossed and on a ledge, as meshes") {
  for (bool meshes : {false, true}) {
    const auto make = [&](const Vec3& h) { return meshes ? mesh(make_mesh::box(h)) : box(h); };
    const auto bar = mesh(make_mesh::box({1, 0.1, 0.1})), other = make({1, 0.1, 0.1});
    // crossed bars, a millimetre into each other
    auto list =
        run(*bar, {}, *other, {{0, 0.199, 0}, axis_angle(Vec3::UnitY(), det::pi / 2)}, 0.02);
    Deepest d = deepest(list);
    CHECK(d.gap == doctest::Approx(-0.001));
    CHECK((d.normal - Vec3::UnitY()).norm() < 1e-9);
    CHECK(d.points == 4);
    // on a ledge: one corner region over the edge, all contacts point up
    const auto table = mesh(make_mesh::box({1, 0.5, 1})), brick = make({0.2, 0.1, 0.1});
    list = run(*table, {}, *brick, {{0.9, 0.599, 0.3}, Quat::Identity()}, 0.02);
    REQUIRE(!list.empty());
    for (const Manifold& m : list) CHECK(m.normal.y() > 0.999);
    d = deepest(list);
    CHECK(d.gap == doctest::Approx(-0.001));
    CHECK(d.points >= 3);
    // equal boxes exactly on top of each other
    list = run(*table, {}, *table, {{0, 0.999, 0}, Quat::Identity()}, 0.02);
    d = deepest(list);
    CHECK((d.normal - Vec3::UnitY()).norm() < 1e-9);
    CHECK(d.points >= 4);
    CHECK(d.gap == doctest::Approx(-0.001));
  }
}

TEST_CASE("a box slides and a ball rolls over a tessellated floor without ghost hits") {
  const auto floor = mesh(make_mesh::terrain(10, 40, [](double, double) { return 0.0; }));
  const auto slab = mesh(make_mesh::box({5, 0.25, 5}));
  Random r(33);
  const auto hull_shape =
      hull({{-.3, -.2, -.3}, {.3, -.2, -.3}, {-.3, -.2, .3}, {.3, -.2, .3}, {0, .5, 0}});
  struct Thing {
    std::shared_ptr<const Shape> shape;
    double height;
    Quat q;
  };
  const Quat lying = axis_angle(Vec3::UnitX(), det::pi / 2);
  const std::vector<Thing> things{{box({0.3, 0.2, 0.25}), 0.2, Quat::Identity()},
                                  {sphere(0.3), 0.3, Quat::Identity()},
                                  {capsule(0.2, 0.5), 0.2, lying},
                                  {cylinder(0.25, 0.4), 0.2, Quat::Identity()},
                                  {cylinder(0.25, 0.4), 0.25, lying},
                                  {hull_shape, 0.2, Quat::Identity()},
                                  {ellipsoid({0.3, 0.2, 0.25}), 0.2, Quat::Identity()},
                                  {cone(0.25, 0.4), 0.2, Quat::Identity()},
                                  {tapered_capsule(0.3, 0.1, 0.5), 0.2,
                                   axis_angle(Vec3::UnitZ(), det::pi / 2 + det::asin(0.4))},
                                  {mesh(make_mesh::box({0.3, 0.2, 0.25})), 0.2, Quat::Identity()}};
  for (const auto& ground : {floor, slab}) {
    const Pose below{{0, ground == slab ? -0.25 : 0.0, 0}, Quat::Identity()};
    for (size_t k = 0; k < things.size(); ++k) {
      CAPTURE(k);
      for (int i = 0; i < cases(200); ++i) {
        const double gap = i % 3 == 0 ? -0.002 : i % 3 == 1 ? 0.0 : 0.003;
        const Pose p{{r.uniform(-3, 3), things[k].height + gap, r.uniform(-3, 3)},
                     axis_angle(Vec3::UnitY(), r.uniform(0, 6)) * things[k].q};
        const auto list = run(*ground, below, *things[k].shape, p, 0.02);
        REQUIRE(!list.empty());
        for (const Manifold& m : list) CHECK(m.normal.y() > 0.99999);
        CHECK(deepest(list).gap == doctest::Approx(gap).epsilon(0.01));
        CHECK(list.size() == 1);
        // upright things stand, lying ones lie on two points, balls on one
        const int expected = k == 1 || k == 6 ? 1 : k == 2 || k == 4 || k == 8 ? 2 : 4;
        CHECK(deepest(list).points == expected);
      }
    }
  }
}

TEST_CASE(
    "smooth shapes near a mesh: the least gap is the distance, pushed in, depth and way out") {
  Random r(35);
  const auto torus = mesh(make_mesh::torus(0.5, 0.2, 24, 12)),
             block = mesh(make_mesh::box({0.5, 0.4, 0.3}));
  const std::vector<std::shared_ptr<const Shape>> things{
      cylinder(0.4, 0.8), capsule(0.3, 0.6),          sphere(0.5),
      sphere(0.1),        ellipsoid({0.5, 0.3, 0.4}), tapered_capsule(0.4, 0.2, 0.5),
      cone(0.4, 0.8)};
  for (const auto& m : {torus, block})
    for (size_t k = 0; k < things.size(); ++k) {
      CAPTURE(k);
      const ConvexShape& a = *things[k]->convex();
      int near = 0, off = 0;
      const int n = cases(100);
      for (int i = 0; i < n; ++i) {
        Pose pa{random_vec(r, -0.2, 0.2), random_rotation(r)};
        const Pose pb{Vec3::Zero(), random_rotation(r)};
        // out along a direction until the gap is about a centimetre
        const Vec3 d = random_direction(r), x0 = pa.x;
        double lo = 0, hi = 3;
        for (int step = 0; step < 16; ++step) {
          const double s = 0.5 * (lo + hi);
          pa.x = x0 + s * d;
          (convex_distance(a, pa, *m, pb).gap < 0.01 ? lo : hi) = s;
        }
        pa.x = x0 + hi * d;
        const auto centre = closest_point(*m, pb, pa.x);
        if (centre && centre->distance < 0) continue;  // near the surface, but inside
        const Deepest exact = convex_distance(a, pa, *m, pb);
        if (!(exact.gap > 0 && exact.gap < 0.015)) continue;
        ++near;
        CHECK(deepest(run(a, pa, *m, pb, 0.02)).gap == doctest::Approx(exact.gap).epsilon(1e-3));
        for (double depth : {1e-4, 2e-3, 0.02, 0.05}) {
          const Pose in{pa.x + exact.normal * (exact.gap + depth), pa.q};
          const Deepest found = deepest(run(a, in, *m, pb, 0.01));
          const bool good = found.gap < 0 && found.gap > -1.6 * depth - 1e-3 &&
                            found.gap < -0.3 * depth && found.normal.dot(exact.normal) > 0.5;
          if (good) continue;
          ++off;
        }
      }
      if (n >= 50) CHECK(near > n / 4);
      CHECK(off <= 4 * near / 20);
    }
}

TEST_CASE("thin plates stop each other from the right side") {
  const auto plate = mesh(make_mesh::box({0.5, 0.001, 0.5})),
             block = mesh(make_mesh::box({0.2, 0.2, 0.2}));
  for (double depth : {0.0005, 0.0015, 0.004}) {
    // a block pressed into the plate from above, farther than the plate is thick
    auto list = run(*plate, {}, *block,
                    {{0.05, 0.201 - depth, 0.02}, axis_angle(Vec3::UnitY(), 0.3)}, 0.01);
    Deepest d = deepest(list);
    CHECK(d.normal.y() > 0.999);
    CHECK(d.gap == doctest::Approx(-depth).epsilon(0.01));
    // and from below
    list = run(*plate, {}, *block, {{0.05, -0.201 + depth, 0.02}, axis_angle(Vec3::UnitY(), 0.3)},
               0.01);
    d = deepest(list);
    CHECK(d.normal.y() < -0.999);
    CHECK(d.gap == doctest::Approx(-depth).epsilon(0.01));
  }
}

TEST_CASE("meshes that touch exactly, at any slant, have no depth") {
  // The closed form is a gap of zero. Rounding lets the surfaces cross, and coincident edges are
  // looked at from a hair's breadth aside: 3e-7 of the smaller one's size.
  Random r(59);
  const double size = 0.2;
  const auto block = mesh(make_mesh::box(Vec3::Constant(0.5 * size)));
  const auto sheet = mesh(make_mesh::terrain(2, 4, [](double, double) { return 0.0; }));
  const auto valley = mesh(make_mesh::terrain(2, 2, [](double x, double) { return std::abs(x); }));
  for (int i = 0; i < cases(2000); ++i) {
    const Pose frame{random_vec(r, -1, 1), random_rotation(r)};
    const double z = r.uniform(-0.5, 0.5);
    // On a face over corners and sides of the sheet's squares; and on edge in the bottom.
    const Pose flat{{0.1 * double(i % 3), 0.5 * size, i % 2 ? z : 0.1}, Quat::Identity()};
    const Pose edge{{0, size * std::sqrt(0.5), z}, axis_angle(Vec3::UnitZ(), det::pi / 4)};
    for (const auto& [ground, pose] : {std::pair(&sheet, flat), std::pair(&valley, edge)}) {
      const Deepest d = deepest(run(**ground, frame, *block, frame * pose, 0.01));
      CHECK(d.gap > -1e-6 * size);
    }
  }
}

TEST_CASE("an open sheet holds what is above it and leaves alone what is below") {
  const auto sheet = mesh(make_mesh::terrain(
      4, 8, [](double x, double z) { return 0.05 * det::sin(2 * x) * det::cos(z); }));
  const auto b = mesh(make_mesh::torus(0.3, 0.1, 24, 12));
  Deepest d = deepest(run(*sheet, {}, *b, {{0.1, 0.1, 0.1}, Quat::Identity()}, 0.02));
  CHECK(d.gap < 0);
  CHECK(d.normal.y() > 0.5);
  CHECK(run(*sheet, {}, *b, {{0.1, -0.3, 0.1}, Quat::Identity()}, 0.02).empty());
}

TEST_CASE("the same call gives the same bits") {
  Random r(34);
  const auto a = mesh(make_mesh::torus(0.5, 0.2, 24, 12)),
             b = mesh(make_mesh::torus(0.5, 0.12, 32, 14));
  for (int i = 0; i < cases(50); ++i) {
    const Pose pa{random_vec(r, -1, 1), random_rotation(r)};
    const Pose pb{pa.x + random_direction(r) * r.uniform(0.3, 1), random_rotation(r)};
    const auto x = run(*a, pa, *b, pb, 0.02);
    run(*b, pb, *a, pa, 0.05);
    const auto y = run(*a, pa, *b, pb, 0.02);
    REQUIRE(x.size() == y.size());
    for (size_t k = 0; k < x.size(); ++k) {
      CHECK(x[k].normal == y[k].normal);
      CHECK(x[k].part == y[k].part);
      REQUIRE(x[k].count == y[k].count);
      for (size_t l = 0; l < size_t(x[k].count); ++l) {
        CHECK(x[k].points[l].x_world == y[k].points[l].x_world);
        CHECK(x[k].points[l].feature == y[k].points[l].feature);
      }
    }
  }
}
