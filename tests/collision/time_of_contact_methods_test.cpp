// Every method for the time of contact. References: the quadratic of two balls, the height of a
// rod's ends and the separating axes of boxes, sampled and bisected in extended precision with
// Rodrigues' rotations; for the rest the methods against each other and the narrow phase.
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/time_of_contact.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/time_of_contact_answers.hpp"
#include "tests/collision/time_of_contact_reference.hpp"

using namespace tumble;
using namespace tumble::test;

TEST_CASE("every method: two balls, also off their carriers' centres") {
  Random r(301);
  const double tolerance = 1e-6;
  int hits = 0;
  const int n = cases(500);
  for (int i = 0; i < n; ++i) {
    const double ra = r.uniform(0.1, 0.5), rb = r.uniform(0.1, 0.5);
    Motion ma = motion_for({random_vec(r, -3, 3), random_rotation(r)}, random_vec(r, -2, 2),
                           random_vec(r, -8, 8), 1);
    Motion mb = motion_for({random_vec(r, -3, 3), random_rotation(r)}, Vec3::Zero(),
                           random_vec(r, -8, 8), 1);
    mb.velocity = ma.velocity + (ma.start.x - mb.start.x) * r.uniform(0.2, 2);
    mb.velocity += random_vec(r, -0.8, 0.8);
    if (i % 2) ma.offset.x = random_vec(r, -0.4, 0.4), mb.offset.x = random_vec(r, -0.4, 0.4);
    const auto gap = [&](long double t) {
      return (long_pose(mb, t).x - long_pose(ma, t).x).norm() - ra - rb;
    };
    if (gap(0) < 1e-3) continue;
    const long double exact = first_zero(0, 1, 500, gap);
    const bool late = fabsl(exact - 1) < 1e-4L;
    for (const Answer& x : answers(*sphere(ra), ma, *sphere(rb), mb, tolerance)) {
      CAPTURE(x.name);
      check_form(x.toc, ma, tolerance);
      CHECK(x.toc.time <= exact);
      if (!late && exact <= 1) CHECK(x.toc.hit());
      if (x.toc.hit()) CHECK(gap(x.toc.time) <= 1.01 * tolerance);
      if (x.toc.hit() && x.toc.distance_high <= 0) CHECK(x.toc.high >= double(exact) - 1e-12);
      if (x.name == "sphere_sphere") CHECK((i % 2 || x.toc.method == "sphere_sphere"));
      hits += x.toc.hit();
    }
  }
  if (n >= 100) CHECK((hits > 0.3 * 12 * n && hits < 0.9 * 12 * n));
}

TEST_CASE("every method: a rod that spins through many turns meets a plane, a slab, a mesh") {
  Random r(302);
  const double radius = 0.02, length = 1, tolerance = 1e-5;
  const auto rod = capsule(radius, length);
  const auto plane = half_space(), slab = box({5, 1, 5}), ground = mesh(make_mesh::box({5, 1, 5}));
  for (int i = 0; i < cases(60); ++i) {
    const Motion m = motion_for({{0, r.uniform(0.7, 1.5), 0}, random_rotation(r)},
                                {r.uniform(-1, 1), r.uniform(-4, 0), 0},
                                random_direction(r) * r.uniform(0, i % 3 ? 20 : 100), 0.4);
    const auto height = [&](long double t) {
      const LongPose p = long_pose(m, t);
      return p.x.y() - fabsl(p.R(1, 1)) * length / 2 - radius;
    };
    const long double exact = first_zero(0, 0.4, 4000, height);
    const Motion still = Motion::at_rest({}, 0, 0.4);
    const Motion below = Motion::at_rest({{0, -1, 0}, Quat::Identity()}, 0, 0.4);
    for (const auto& [floor, pose] :
         {std::pair{plane, still}, std::pair{slab, below}, std::pair{ground, below}}) {
      for (const Answer& x : answers(*floor, pose, *rod, m, tolerance)) {
        CAPTURE(x.name);
        check_form(x.toc, m, tolerance);
        CHECK(x.toc.time <= exact);
        if (exact <= 0.4L) CHECK((x.toc.hit() || x.toc.status == Toc::max_iterations));
        if (!x.toc.hit()) continue;
        CHECK(height(x.toc.time) <= 1.01 * tolerance);
        CHECK(x.toc.normal.y() == doctest::Approx(1));
        CHECK(x.toc.features[1].kind == FeatureKind::vertex);
        CHECK(x.toc.features[0].kind == FeatureKind::face);
      }
    }
  }
}

TEST_CASE("every method: boxes that turn and travel") {
  Random r(303);
  const double tolerance = 1e-5;
  int hits = 0, all = 0;
  for (int i = 0; i < cases(120); ++i) {
    const Vec3 ha = random_vec(r, 0.05, 0.5), hb = random_vec(r, 0.01, 0.5);
    Motion ma = motion_for({Vec3::Zero(), random_rotation(r)}, random_vec(r, -1, 1),
                           random_vec(r, -12, 12), 0.5);
    Motion mb = motion_for({random_direction(r) * 2.5, random_rotation(r)}, Vec3::Zero(),
                           random_vec(r, -12, 12), 0.5);
    mb.velocity = -mb.start.x * r.uniform(1, 6) + random_vec(r, -2, 2);
    if (i % 3 == 0) mb.offset = {random_vec(r, -0.3, 0.3), random_rotation(r)};
    const auto gap = [&](long double t) {
      return box_gap(ha, long_pose(ma, t), hb, long_pose(mb, t));
    };
    if (gap(0) < 1e-3L) continue;
    const long double exact = first_zero(0, 0.5, 1000, gap);
    for (const Answer& x : answers(*box(ha), ma, *box(hb), mb, tolerance)) {
      CAPTURE(x.name);
      check_form(x.toc, ma, tolerance);
      CHECK(x.toc.time <= exact);
      if (exact <= 0.5L) CHECK(x.toc.hit());
      if (x.name == "box_box") CHECK(x.toc.method == "box_box");
      ++all;
      if (!x.toc.hit()) continue;
      ++hits;
      CHECK(gap(x.toc.time) <= 1.01 * tolerance);
      const Vec3 pa = ma.pose(x.toc.time).inverse_point(x.toc.on_a);
      const Vec3 pb = mb.pose(x.toc.time).inverse_point(x.toc.on_b);
      CHECK((pa.cwiseAbs() - ha).maxCoeff() == doctest::Approx(0).epsilon(1e-9));
      CHECK((pb.cwiseAbs() - hb).maxCoeff() == doctest::Approx(0).epsilon(1e-9));
    }
  }
  if (all >= 100) CHECK((hits > 0.3 * all && hits < 0.97 * all));
}

TEST_CASE("all methods agree on convex shapes, meshes and thin shells, slow, fast and spinning") {
  Random r(304);
  const std::vector<std::shared_ptr<const Shape>> shapes{
      sphere(0.3),
      capsule(0.02, 1),
      box({0.4, 5e-5, 0.4}),
      cylinder(0.3, 0.1),
      random_hull(r, 20, {0.5, 0.4, 0.2}),
      mesh(make_mesh::torus(0.4, 0.1, 10, 6)),
      mesh(make_mesh::box({0.5, 5e-5, 0.5})),
      mesh(make_mesh::terrain(1, 4, [](double x, double z) { return 0.2 * x * z; })),
  };
  int hits = 0, all = 0;
  const int n = cases(400);
  for (int i = 0; i < n; ++i) {
    const auto& a = shapes[r.below(uint32_t(shapes.size()))];
    const auto& b = shapes[r.below(uint32_t(shapes.size()))];
    const double tick = 1.0 / 60, tolerance = 1e-5;
    const Vec3 way = random_direction(r);
    Motion ma = motion_for({Vec3::Zero(), random_rotation(r)}, random_vec(r, -1, 1),
                           random_direction(r) * std::exp(r.uniform(0, 6)), tick);
    Motion mb = motion_for({1.7 * way, random_rotation(r)}, Vec3::Zero(),
                           random_direction(r) * std::exp(r.uniform(0, 6)), tick);
    mb.velocity = (random_vec(r, -0.4, 0.4) - 1.7 * way) * std::exp(r.uniform(3.5, 6.5));
    const std::vector<Answer> found = answers(*a, ma, *b, mb, tolerance);
    double last = 0;
    bool known = true;
    for (const Answer& x : found) known = known && x.toc.status != Toc::max_iterations;
    for (const Answer& x : found) {
      CAPTURE(i);
      CAPTURE(x.name);
      check_form(x.toc, ma, tolerance);
      if (known) CHECK(x.toc.status == found.front().toc.status);
      last = std::max(last, x.toc.time);
      ++all, hits += x.toc.hit();
    }
    for (int k = 0; k < 40; ++k) {
      std::vector<Manifold> out;
      collide(*a, ma.pose(last * k / 40), *b, mb.pose(last * k / 40), 0, out);
      CHECK(out.empty());
    }
  }
  if (n >= 100) CHECK((hits > 0.3 * all && hits < 0.95 * all));
}

TEST_CASE("a shell of 0.1 mm is never missed at 1000 m/s by a spinning rod of any kind") {
  Random r(305);
  const double half = 5e-5, tick = 1.0 / 60, tolerance = 1e-5;
  const std::vector<std::shared_ptr<const Shape>> rods{
      capsule(0.005, 0.6), box({0.005, 0.3, 0.005}), cylinder(0.005, 0.6),
      random_hull(r, 24, {0.005, 0.3, 0.005}), mesh(make_mesh::box({0.005, 0.3, 0.005}))};
  const std::vector<std::shared_ptr<const Shape>> shells{box({2, 2, half}),
                                                         mesh(make_mesh::box({2, 2, half}))};
  for (int i = 0; i < cases(40); ++i) {
    const Motion m = motion_for({{r.uniform(-1, 1), r.uniform(-1, 1), -8}, random_rotation(r)},
                                {0, 0, 1000}, random_direction(r) * r.uniform(0, 600), tick);
    for (const auto& rod : rods) {
      for (const auto& shell : shells) {
        for (const Answer& x : answers(*shell, Motion::at_rest({}, 0, tick), *rod, m, tolerance)) {
          CAPTURE(x.name);
          REQUIRE(x.toc.hit());
          check_form(x.toc, m, tolerance);
          CHECK(x.toc.on_a.z() == doctest::Approx(-half).epsilon(1e-6));
          CHECK(m.pose(x.toc.time).x.z() < -half);
        }
      }
    }
  }
}

TEST_CASE("the features that touch have the numbers of the polyhedra and meshes") {
  const double tolerance = 1e-6;
  const Motion still = Motion::at_rest({}, 0, 1);
  const auto cube = box({0.5, 0.5, 0.5}), cube_mesh = mesh(make_mesh::box({0.5, 0.5, 0.5}));
  // On its corner (-,-,-), which is vertex 0 of a box, turned to point down.
  const Quat on_corner = rotation_between(Vec3(-1, -1, -1).normalized(), -Vec3::UnitY());
  const Motion falls = motion_for({{0.1, 2, 0.2}, on_corner}, {0, -2, 0}, Vec3::Zero(), 1);
  for (const auto& floor : {cube, cube_mesh}) {
    for (const Answer& x : answers(*floor, still, *cube, falls, tolerance)) {
      CAPTURE(x.name);
      REQUIRE(x.toc.hit());
      const size_t box_side = 1;
      CHECK(x.toc.features[box_side] == PolyhedronFeature{FeatureKind::vertex, 0});
      CHECK(x.toc.features[0].kind == FeatureKind::face);
      if (floor == cube_mesh) CHECK(x.toc.features[0].index == x.toc.triangle_a);
    }
  }
  // An edge along x across an edge along z.
  const Motion ridge = Motion::at_rest({{0, 0, 0}, axis_angle(Vec3::UnitZ(), det::pi / 4)}, 0, 1);
  const Motion keel = motion_for({{0.1, 3, 0.2}, axis_angle(Vec3::UnitX(), det::pi / 4)},
                                 {0, -2, 0}, Vec3::Zero(), 1);
  for (const auto& below : {cube, cube_mesh}) {
    for (const Answer& x : answers(*below, ridge, *cube, keel, tolerance)) {
      CAPTURE(x.name);
      REQUIRE(x.toc.hit());
      CHECK(x.toc.features[0].kind == FeatureKind::edge);
      CHECK(x.toc.features[1].kind == FeatureKind::edge);
    }
  }
  const auto rod = capsule(0.1, 1);
  const Motion upright = motion_for({{0.1, 3, 0.2}, Quat::Identity()}, {0, -2, 0}, Vec3::Zero(), 1);
  for (const Answer& x : answers(*rod, upright, *cube, still, tolerance)) {
    REQUIRE(x.toc.hit());
    CHECK(x.toc.features[0] == PolyhedronFeature{FeatureKind::vertex, 0});
    CHECK(x.toc.features[1].kind == FeatureKind::face);
  }
}

TEST_CASE("a method that does not apply is answered by one that does, and the answer says which") {
  const Motion still = Motion::at_rest({}, 0, 1);
  const Motion falls = motion_for({{0, 3, 0}, Quat::Identity()}, {0, -4, 0}, Vec3::Zero(), 1);
  const auto asked = [&](const Shape& a, const Shape& b, std::string_view name) {
    TimeOfContactOptions options;
    options.method = &method_named(name);
    const TimeOfContact t = time_of_contact(a, still, b, falls, 1e-5, options);
    CHECK(t.hit());
    return t.method;
  };
  const auto plane = half_space(), b = box({0.5, 0.5, 0.5}), c = cylinder(0.5, 1),
             ball = sphere(0.5);
  const auto m = mesh(make_mesh::box({0.5, 0.5, 0.5}));
  CHECK(asked(*plane, *b, "continuous_triangles") == "conservative_advancement");
  CHECK(asked(*c, *m, "continuous_triangles") == "conservative_advancement");
  CHECK(asked(*b, *m, "box_box") == "continuous_triangles");
  CHECK(asked(*b, *b, "sphere_sphere") == "conservative_advancement");
  CHECK(asked(*ball, *ball, "automatic") == "sphere_sphere");
  CHECK(asked(*plane, *m, "bisection") == "bisection");
  CHECK(asked(*m, *m, "bisection") == "bisection");
  CHECK(asked(*ball, *m, "continuous_triangles") == "continuous_triangles");
}
