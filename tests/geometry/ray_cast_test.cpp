// Ray casts. References: sphere tracing with the shapes' signed distance functions (Quilez's closed
// forms), a barycentric solve of the 3x3 system for triangles, and watertightness of closed meshes.
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/geometry/hull/convex_hull.hpp"
#include "engine/geometry/make_mesh.hpp"
#include "tests/geometry/draws.hpp"
#include "tests/support/dense3.hpp"

#include <algorithm>
#include <functional>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double far = 100;
using Distance = std::function<double(const Vec3&)>;

/// First t at which a ray comes within 1e-9 of a solid; < 0 for none. `grazing` tells that the ray
/// passed so close that either answer is right.
double march(const Ray& ray, const Distance& distance, double t_max, bool& grazing) {
  const double length = ray.direction.norm();
  double t = 0, least = far;
  for (int i = 0; i < 100000 && t <= t_max; ++i) {
    const double d = distance(ray.at(t));
    if (d < 1e-9) {
      // Does it really go in?
      grazing = distance(ray.at(t + 1e-4 / length)) > -1e-6;
      return t;
    }
    least = std::min(least, d);
    t += d / length;
  }
  grazing = least < 1e-5;
  return -1;
}

void compare(const std::function<std::optional<RayHit>(const Ray&, double)>& cast,
             const Distance& distance, uint64_t seed) {
  Random random(seed);
  const int n = draws::count(20000);
  int hits = 0, inside = 0;
  for (int i = 0; i < n; ++i) {
    Ray ray{draws::in_box(random, 3), draws::direction(random) * random.uniform(0.1, 10)};
    if (i % 2) ray.direction = draws::in_box(random, 1) - ray.origin;
    if (i % 16 == 3) ray.direction = Vec3::Unit(int(random.below(3))) * 2;
    const double t_max = i % 5 == 0 ? 0.3 : far;
    bool grazing = false;
    const double expected = march(ray, distance, t_max, grazing);
    if (grazing) continue;
    const auto hit = cast(ray, t_max);
    if (expected > t_max - 1e-6 && expected < t_max + 1e-6) continue;
    REQUIRE(hit.has_value() == (expected >= 0));
    if (!hit) continue;
    ++hits;
    CHECK(std::fabs(hit->t - expected) * ray.direction.norm() < 1e-4);
    CHECK(hit->normal.norm() == doctest::Approx(1));
    if (distance(ray.origin) < 0) {
      ++inside;
      CHECK(hit->t == 0);
      CHECK(hit->normal.isApprox(-ray.direction.normalized()));
      continue;
    }
    const Vec3 p = ray.at(hit->t);
    CHECK(std::fabs(distance(p)) < 1e-12);
    CHECK(hit->normal.dot(ray.direction) <= 0);
    // Outward: the distance grows along the normal as fast as one walks.
    CHECK(distance(p + 1e-6 * hit->normal) == doctest::Approx(1e-6).epsilon(1e-3));
  }
  if (n > 1000) {
    CHECK(hits > n * 2 / 10);
    CHECK(hits < n * 9 / 10);
    CHECK(inside > 0);
  }
}

}  // namespace

TEST_CASE("rays against sphere, box, capsule, cylinder, half-space, convex: as sphere tracing") {
  const Vec3 centre(0.2, -0.1, 0.3), half(1.2, 0.7, 0.4);
  SUBCASE("sphere") {
    compare([&](const Ray& r, double t) { return ray_sphere(r, centre, 1.1, t); },
            [&](const Vec3& p) { return (p - centre).norm() - 1.1; }, 60);
  }
  const Distance box = [&](const Vec3& p) {
    const Vec3 q = p.cwiseAbs() - half;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  };
  SUBCASE("box") {
    compare([&](const Ray& r, double t) { return ray_box(r, half, t); }, box, 61);
  }
  SUBCASE("convex") {
    const auto hull = convex_hull(make_mesh::box(half).vertices);
    compare(
        [&](const Ray& r, double t) {
          return ray_convex(r, hull->polyhedron.planes.data(), hull->polyhedron.planes.size(), t);
        },
        box, 62);
  }
  SUBCASE("capsule") {
    compare(
        [&](const Ray& r, double t) { return ray_capsule(r, 0.8, 0.7, t); },
        [&](const Vec3& p) { return (p - Vec3(0, std::clamp(p.y(), -0.8, 0.8), 0)).norm() - 0.7; },
        63);
  }
  SUBCASE("cylinder") {
    compare([&](const Ray& r, double t) { return ray_cylinder(r, 0.8, 0.9, t); },
            [&](const Vec3& p) {
              const Vec2 q(std::hypot(p.x(), p.z()) - 0.9, std::fabs(p.y()) - 0.8);
              return q.cwiseMax(Vec2::Zero()).norm() + std::min(q.maxCoeff(), 0.0);
            },
            64);
  }
  SUBCASE("half-space") {
    const Plane plane{Vec3(1, 2, 3).normalized(), 0.4};
    compare([&](const Ray& r, double t) { return ray_half_space(r, plane, t); },
            [&](const Vec3& p) { return plane.distance(p); }, 65);
  }
}

TEST_CASE("a ray of no length, and rays that start on a surface") {
  const Ray still{Vec3(0, 0.1, 0), Vec3::Zero()}, outside{Vec3(0, 5, 0), Vec3::Zero()};
  CHECK(ray_sphere(still, Vec3::Zero(), 1, far).value().t == 0);
  CHECK(ray_box(still, Vec3::Ones(), far).value().t == 0);
  CHECK(ray_cylinder(still, 1, 1, far).value().t == 0);
  CHECK(ray_half_space(still, {Vec3::UnitY(), 1}, far).value().t == 0);
  CHECK_FALSE(ray_sphere(outside, Vec3::Zero(), 1, far));
  CHECK_FALSE(ray_box(outside, Vec3::Ones(), far));
  CHECK_FALSE(ray_cylinder(outside, 1, 1, far));
  CHECK_FALSE(ray_capsule(outside, 1, 1, far));
  CHECK_FALSE(ray_half_space(outside, {Vec3::UnitY(), 1}, far));
  const Ray in{Vec3(1, 0, 0), -Vec3::UnitX()}, out{Vec3(1, 0, 0), Vec3::UnitX()};
  CHECK(ray_sphere(in, Vec3::Zero(), 1, far).value().t == 0);
  CHECK(ray_box(in, Vec3::Ones(), far).value().normal == Vec3::UnitX());
  CHECK_FALSE(ray_sphere(out, Vec3::Zero(), 1, far));
  CHECK_FALSE(ray_box(out, Vec3::Ones(), far));
}

TEST_CASE("a sphere is hit accurately from a million radii away") {
  const Ray ray{Vec3(1e6, 0.5, 0), -Vec3::UnitX()};
  const auto hit = ray_sphere(ray, Vec3::Zero(), 1, 1e7);
  REQUIRE(hit);
  CHECK(std::fabs(1e6 - hit->t - std::sqrt(0.75)) < 1e-9);
}

TEST_CASE("rays against triangles solve the 3x3 system, with the side they see") {
  Random random(66);
  int hits = 0, fronts = 0;
  const int n = draws::count(50000);
  for (int i = 0; i < n; ++i) {
    const auto t = draws::triangle(random);
    Ray ray{draws::in_box(random, 2), draws::direction(random)};
    if (i % 2) ray.direction = (t[0] + t[1] + t[2]) / 3 + draws::in_box(random, 0.4) - ray.origin;
    const Mat3 m = Mat3::from_columns(t[1] - t[0], t[2] - t[0], -ray.direction);
    const Vec3 solution = solve(m, ray.origin - t[0]);
    const double u = solution.x(), v = solution.y(), s = solution.z();
    const double margin = std::min({u, v, 1 - u - v, s});
    if (std::fabs(margin) < 1e-9 || std::fabs(m.determinant()) < 1e-6) continue;
    const auto hit = ray_triangle(ray, t, far);
    REQUIRE(hit.has_value() == (margin > 0 && s < far));
    if (!hit) continue;
    ++hits;
    fronts += hit->front;
    CHECK(hit->t == doctest::Approx(s).epsilon(1e-7));
    CHECK((hit->barycentric - Vec3(1 - u - v, u, v)).norm() < 1e-7);
    CHECK(hit->front == ((t[1] - t[0]).cross(t[2] - t[0]).dot(ray.direction) < 0));
  }
  if (n > 1000) {
    CHECK(hits > n / 10);
    CHECK(fronts > hits / 3);
    CHECK(fronts < hits * 2 / 3);
  }
}

TEST_CASE("no ray slips between the triangles of a closed mesh, aimed at edges and vertices") {
  Random random(67);
  const TriangleMesh mesh = make_mesh::icosphere(1, 2);
  for (int i = 0; i < draws::count(3000); ++i) {
    const size_t t = random.below(uint32_t(mesh.triangles.size()));
    const double s = i % 3 == 0 ? 0 : random.uniform();
    const Vec3 target = mesh.corner(t, 0) + s * (mesh.corner(t, 1) - mesh.corner(t, 0));
    const Vec3 origin = i % 2 ? Vec3(draws::direction(random) * 3) : draws::in_box(random, 0.4);
    // Through the middle of the ball rather than along its rim.
    if (i % 2 && (target - origin).normalized().dot(target.normalized()) > -0.3) continue;
    const RayShear shear({origin, target - origin});
    bool hit = false;
    for (size_t k = 0; k < mesh.triangles.size(); ++k) {
      hit = hit || shear.triangle(mesh.corner(k, 0), mesh.corner(k, 1), mesh.corner(k, 2), far);
    }
    CHECK(hit);
  }
}
