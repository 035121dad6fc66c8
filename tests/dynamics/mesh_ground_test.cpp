// Bodies on open meshes under the exact stepper. References: a valley of two planes is an
// intersection of half-spaces, above which every corner stays; without restitution and with
// friction the energy never grows.
#include "engine/core/random.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/dynamics/piles.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 within(Random& random, double x, double y, double z) {
  const double a = random.uniform(-x, x), b = random.uniform(-y, y), c = random.uniform(-z, z);
  return {a, b, c};
}

/// Thrown about a metre above the origin, turned and turning in any direction.
BodyDef thrown(const ShapeDef& shape, Random& random) {
  BodyDef d = body(shape, Vec3(0, 1, 0) + within(random, 0.1, 0, 0.1));
  const Vec3 axis = within(random, 1, 1, 1).normalized();
  d.pose.q = axis_angle(axis, random.uniform(0, 3));
  d.velocity = Vec3(0, -2, 0) + within(random, 1, 2, 1);
  d.angular_velocity = within(random, 10, 10, 10);
  return d;
}

/// Greatest rise of the energy from tick to tick, as a share of what there was [-].
double run_and_watch(EventWorld& w, double seconds, const std::function<void()>& look) {
  const double first = w.energy();
  double rise = 0, before = first;
  for (int i = 0; i < int(seconds / w.h + 0.5); ++i) {
    w.step();
    rise = std::max(rise, w.energy() - before);
    before = w.energy();
    look();
  }
  return rise / first;
}

/// Throws each shape `count` times on the ground: it gains no energy, is nowhere too deep, and the
/// least of `height` over all poses, of a body's, stays above `floor`.
void throw_on(const ShapeDef& ground, std::span<const ShapeDef> shapes, int count, uint64_t seed,
              const std::function<double(const RigidBody&)>& height, double floor) {
  Random random(seed);
  for (const ShapeDef& shape : shapes) {
    for (int i = 0; i < graded_count(count, count / 2); ++i) {
      CAPTURE(i);
      CAPTURE(int(shape.type));
      EventWorld w;
      w.fixed(ground);
      const uint32_t b = w.add(thrown(shape, random));
      double lowest = 1;
      const auto look = [&] { lowest = std::min(lowest, height(w.bodies[b])); };
      CHECK(run_and_watch(w, 1, look) < 1e-4);
      CHECK(lowest > floor);
      CHECK(w.deepest < 1e-5);
    }
  }
}

}  // namespace

TEST_CASE("event: what tumbles into a valley of triangles stays above it and gains no energy") {
  const double slope = 0.6;
  const TriangleMesh brick = make_mesh::box({0.1, 0.1, 0.1});
  const auto above = [&](const RigidBody& b) {
    double least = 1;
    for (const Vec3& v : brick.vertices) {
      const Vec3 x = b.pose.point(v);
      least = std::min(least, (x.y() - slope * std::fabs(x.x())) / std::hypot(1, slope));
    }
    return least;
  };
  throw_on(mesh(make_mesh::terrain(3, 2, [&](double x, double) { return slope * std::fabs(x); })),
           std::array{mesh(brick), hull(brick), box(0.1, 0.1, 0.1)}, 8, 71, above, -1e-5);
}

TEST_CASE("event: what tumbles over rough ground of triangles is not thrown about by it") {
  throw_on(
      mesh(make_mesh::terrain(
          4, 16, [](double x, double z) { return 0.1 * std::sin(7 * x) * std::cos(5 * z); })),
      std::array{mesh(make_mesh::box({0.1, 0.1, 0.1})), box(0.1, 0.1, 0.1),
                 mesh(make_mesh::tetrahedron(0.2)), cylinder(0.1, 0.2)},
      4, 72, [](const RigidBody& b) { return b.pose.x.y(); }, -0.1);
}

TEST_CASE("event: boxes as meshes that stand face on face, side above side, stay as they are") {
  const ShapeDef brick = mesh(make_mesh::box({0.1, 0.1, 0.1}));
  const ShapeDef ground = mesh(make_mesh::terrain(4, 8, [](double, double) { return 0.0; }));
  for (const double x : {0.25, 0.2, 0.13}) {
    for (const double z : {0.25, 0.17}) {
      CAPTURE(x);
      CAPTURE(z);
      EventWorld w;
      w.fixed(ground);
      for (int i = 0; i < 3; ++i) w.add(body(brick, {x, 0.1 + 0.2 * i, z}));
      w.run(0.1);
      for (uint32_t i = 1; i <= 3; ++i) {
        CHECK((w.bodies[i].pose.x - Vec3(x, 0.2 * i - 0.1, z)).norm() < 1e-8);
        CHECK(w.bodies[i].v.norm() < 1e-8);
      }
    }
  }
}
