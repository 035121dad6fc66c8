// References: closed forms of balls, boxes and planes; the definition of the closest point (on the
// surface, and nothing nearer among samples); rays against rays in the shape's own frame.
#include "engine/collision/query.hpp"

#include "engine/geometry/make_mesh.hpp"
#include "tests/collision/support.hpp"

using namespace tumble;
using namespace tumble::test;

TEST_CASE("closest points of a box as box, hull and mesh, inside and outside") {
  Random r(41);
  const Vec3 h(0.5, 0.3, 0.8);
  const auto as_box = box(h), as_mesh = mesh(make_mesh::box(h)),
             as_hull = hull(make_mesh::box(h).vertices);
  int inside = 0;
  const int n = cases(500);
  for (int i = 0; i < n; ++i) {
    const Pose pose{random_vec(r, -2, 2), random_rotation(r)};
    const Vec3 p = random_vec(r, -1, 1);
    const Vec3 out = (p.cwiseAbs() - h).cwiseMax(0.0);
    const double exact = out.norm() > 0 ? out.norm() : (p.cwiseAbs() - h).maxCoeff();
    inside += exact < 0;
    for (const auto& s : {as_box, as_mesh, as_hull}) {
      const auto c = closest_point(*s, pose, pose.point(p));
      REQUIRE(c);
      CHECK(c->distance == doctest::Approx(exact).epsilon(1e-6));
      CHECK((c->x_world + c->distance * c->normal - pose.point(p)).norm() < 1e-6);
      CHECK(std::abs(c->normal.norm() - 1) < 1e-9);
      CHECK(closest_point(*s, pose, pose.point(p), 0.1).has_value() == (exact <= 0.1));
    }
  }
  if (n >= 100) CHECK((inside > 0.05 * n && inside < 0.5 * n));
}

TEST_CASE("rays hit shapes at poses as in their own frames") {
  Random r(42);
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.5),
                                                         capsule(0.3, 0.8),
                                                         box({0.3, 0.4, 0.5}),
                                                         cylinder(0.4, 0.7),
                                                         ellipsoid({0.5, 0.3, 0.2}),
                                                         cone(0.5, 0.8),
                                                         tapered_capsule(0.4, 0.2, 0.5),
                                                         random_hull(r, 30, {0.5, 0.6, 0.4}),
                                                         half_space(),
                                                         mesh(make_mesh::torus(0.5, 0.2, 24, 12))};
  for (const auto& s : shapes) {
    int hits = 0;
    const int n = cases(300);
    for (int i = 0; i < n; ++i) {
      const Pose pose{random_vec(r, -2, 2), random_rotation(r)};
      const Vec3 from = pose.x + random_direction(r) * 3;
      const Ray ray{from, pose.x + random_vec(r, -0.7, 0.7) - from};
      const auto hit = ray_cast(*s, pose, ray, 10);
      if (!hit) continue;
      ++hits;
      const auto on = closest_point(*s, pose, ray.at(hit->t));
      REQUIRE(on);
      if (hit->t == 0) continue;  // started inside
      CHECK(std::abs(on->distance) < 1e-6);
      CHECK(std::abs(hit->normal.norm() - 1) < 1e-9);
      CHECK(!ray_cast(*s, pose, ray, 0.99 * hit->t - 1e-9).has_value());
    }
    if (n >= 100) CHECK(hits > n / 8);
  }
}

TEST_CASE("a half-space's closest point is its foot, NaN gives nothing") {
  const auto plane = half_space();
  const Pose tilted{{0, 1, 0}, axis_angle(Vec3::UnitZ(), 0.5)};
  const auto c = closest_point(*plane, tilted, tilted.point({3, 2, 1}));
  REQUIRE(c);
  CHECK(c->distance == doctest::Approx(2));
  CHECK((c->x_world - tilted.point({3, 0, 1})).norm() < 1e-12);
  CHECK(!closest_point(*plane, {}, {0, std::nan(""), 0}));
}

TEST_CASE("overlap") {
  CHECK(overlap(*box({1, 1, 1}), {}, *sphere(0.5), {{1.4, 0, 0}, Quat::Identity()}));
  CHECK(!overlap(*box({1, 1, 1}), {}, *sphere(0.5), {{1.6, 0, 0}, Quat::Identity()}));
}

TEST_CASE("bad shapes are refused with the value") {
  const double nan = std::nan("");
  const auto text = [](const ShapeDef& def) {
    const auto s = make_shape(def);
    return s.ok() ? std::string() : s.error().text();
  };
  CHECK(text({.type = ShapeType::sphere, .radius = -1}) == "radius must be > 0, got -1 m");
  CHECK(text({.type = ShapeType::sphere, .radius = nan}).find("finite") != std::string::npos);
  CHECK(text({.type = ShapeType::box, .half_extents = {1, 0, 1}}) ==
        "half_extents.y must be > 0, got 0 m");
  CHECK(text({.type = ShapeType::ellipsoid, .half_extents = {1, 2, -3}}) ==
        "half_extents.z must be > 0, got -3 m");
  CHECK(text({.type = ShapeType::capsule, .radius = 1, .height = -2}) ==
        "height must be >= 0, got -2 m");
  CHECK(!text({.type = ShapeType::cylinder, .radius = 1, .height = 1e9}).empty());
  CHECK(text({.type = ShapeType::cone, .radius = 0}) == "radius must be > 0, got 0 m");
  CHECK(text({.type = ShapeType::tapered_capsule, .top_radius = -1}) ==
        "top_radius must be > 0, got -1 m");
  CHECK(text({.type = ShapeType::tapered_capsule, .radius = 0.5, .height = 0.2, .top_radius = 0.1})
            .find("height must be greater than the difference of the radii, 0.4 m, got 0.2 m") !=
        std::string::npos);
  CHECK(!text({.type = ShapeType::triangle_mesh}).empty());
  CHECK(!text({.type = ShapeType::convex_hull}).empty());
  auto broken = std::make_shared<TriangleMesh>();
  broken->vertices = {{0, 0, 0}, {1, 0, 0}, {nan, 1, 0}};
  broken->triangles = {{0, 1, 2}};
  CHECK(!text({.type = ShapeType::triangle_mesh, .mesh = broken}).empty());
  broken->vertices[2] = {0, 1, 0};
  CHECK(text({.type = ShapeType::triangle_mesh, .mesh = broken}).empty());
  broken->triangles = {{0, 1, 9}};
  CHECK(!text({.type = ShapeType::triangle_mesh, .mesh = broken}).empty());
}

TEST_CASE("shapes know their mass, bounds and radii") {
  Random r(43);
  const std::vector<std::shared_ptr<const Shape>> shapes{sphere(0.5),
                                                         capsule(0.3, 0.8),
                                                         box({0.3, 0.4, 0.5}),
                                                         cylinder(0.4, 0.7),
                                                         ellipsoid({0.5, 0.3, 0.2}),
                                                         cone(0.5, 0.8),
                                                         tapered_capsule(0.4, 0.2, 0.5),
                                                         random_hull(r, 30, {0.5, 0.6, 0.4}),
                                                         mesh(make_mesh::torus(0.5, 0.2, 24, 12))};
  for (const auto& s : shapes) {
    const auto m = s->mass_properties();
    REQUIRE(m.ok());
    CHECK(m->mass > 0);
    CHECK(s->inner_radius() > 0);
    CHECK(s->inner_radius() <= s->bounding_radius());
    for (int i = 0; i < cases(50); ++i) {
      const Pose pose{random_vec(r, -2, 2), random_rotation(r)};
      const Aabb b = s->bounds(pose);
      // points of the surface, by closest points of random ones
      const auto c = closest_point(*s, pose, pose.x + random_vec(r, -1, 1));
      REQUIRE(c);
      CHECK(b.inflated(1e-9).contains(c->x_world));
      CHECK((c->x_world - pose.x).norm() <= s->bounding_radius() + 1e-9);
    }
  }
  CHECK(!half_space()->mass_properties().ok());
  CHECK(
      !mesh(make_mesh::terrain(1, 4, [](double, double) { return 0.0; }))->mass_properties().ok());
}
