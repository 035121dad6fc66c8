// Camera mathematics. Reference: closed forms by hand, and that projecting and casting a ray
// through a pixel undo each other.
#include "viewer/render/camera.hpp"

#include "engine/core/random.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

Vec3 clip_point(const Mat4& m, const Vec3& x) {
  const Vec4 c = m * Vec4(x.x(), x.y(), x.z(), 1);
  return c.head<3>() / c.w();
}

Camera random_camera(Random& r) {
  Camera c;
  c.eye = Vec3{r.uniform(-9, 9), r.uniform(-9, 9), 10};
  c.target = Vec3{r.uniform(-5, 5), r.uniform(-5, 5), -3};
  c.fov_deg = r.uniform(10, 120);
  return c;
}

}  // namespace

TEST_CASE("perspective maps the edges of the view to the edges of clip space") {
  const double fov = 90;  // half the height at distance d is d
  const Mat4 p = perspective_matrix(fov, 2.0, 0.5, 50);
  CHECK((clip_point(p, Vec3(0, 3, -3)) - Vec3(0, 1, clip_point(p, Vec3(0, 0, -3)).z())).norm() <
        1e-12);
  CHECK(clip_point(p, Vec3(6, 0, -3)).x() == doctest::Approx(1).epsilon(1e-12));
  CHECK(clip_point(p, Vec3(0, 0, -0.5)).z() == doctest::Approx(-1).epsilon(1e-12));
  CHECK(clip_point(p, Vec3(0, 0, -50)).z() == doctest::Approx(1).epsilon(1e-12));
}

TEST_CASE("orthographic maps its box to the cube") {
  const Mat4 o = orthographic_matrix(-2, 4, 1, 5, 3, 9);
  CHECK((clip_point(o, Vec3(-2, 1, -3)) - Vec3(-1, -1, -1)).norm() < 1e-12);
  CHECK((clip_point(o, Vec3(4, 5, -9)) - Vec3(1, 1, 1)).norm() < 1e-12);
}

TEST_CASE("the view looks along -z with up upwards, for any input") {
  Camera c;
  c.eye = Vec3(3, 2, 1);
  c.target = Vec3(3, 2, -4);
  CHECK((view_matrix(c) * Vec4(3, 2, -4, 1) - Vec4(0, 0, -5, 1)).norm() < 1e-12);
  CHECK((view_matrix(c) * Vec4(3, 3, 1, 1) - Vec4(0, 1, 0, 1)).norm() < 1e-12);
  for (const Vec3& target : {Vec3(3, 2, 1), Vec3(3, 9, 1), Vec3(3, -9, 1), Vec3(NAN, 0, 0)}) {
    c.target = target;
    const Mat3 r = view_matrix(c).linear();
    CHECK((r * r.transpose() - Mat3::Identity()).norm() < 1e-12);
    CHECK(r.determinant() == doctest::Approx(1));
  }
}

TEST_CASE("project and pixel_ray undo each other") {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Camera c = random_camera(random);
    const double x = random.uniform(0, 640), y = random.uniform(0, 360);
    const Ray ray = pixel_ray(c, x, y, 640, 360);
    CHECK(ray.direction.norm() == doctest::Approx(1).epsilon(1e-12));
    const Vec3 p = project(c, ray.origin + random.uniform(0.1, 100) * ray.direction, 640, 360);
    CHECK(std::fabs(p.x() - x) < 1e-8);
    CHECK(std::fabs(p.y() - y) < 1e-8);
    CHECK(p.z() > 0);
  }
  Camera c;
  CHECK(project(c, c.eye + (c.eye - c.target), 640, 360).z() < 0);
}

TEST_CASE("project agrees with the matrices") {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    const Camera c = random_camera(random);
    const Vec3 x =
        c.target + Vec3{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    const Vec3 ndc = clip_point(perspective_matrix(c.fov_deg, 2, 0.1, 100) * view_matrix(c), x);
    const Vec3 p = project(c, x, 200, 100);
    CHECK(std::fabs(p.x() - (0.5 + 0.5 * ndc.x()) * 200) < 1e-8);
    CHECK(std::fabs(p.y() - (0.5 - 0.5 * ndc.y()) * 100) < 1e-8);
  }
}

TEST_CASE("a framed box lies in the picture") {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    Aabb box;
    box.include(Vec3{random.uniform(-5, 0), random.uniform(-5, 0), random.uniform(-5, 0)});
    box.include(Vec3{random.uniform(0.1, 5), random.uniform(0.1, 5), random.uniform(0.1, 5)});
    const double aspect = random.uniform(0.4, 2.5);
    const Camera c = frame_bounds(
        box, Vec3{random.uniform(-1, 1), random.uniform(0.1, 1), random.uniform(-1, 1)}, 40,
        aspect);
    for (int k = 0; k < 8; ++k) {
      const Vec3 x(k & 1 ? box.min.x() : box.max.x(), k & 2 ? box.min.y() : box.max.y(),
                   k & 4 ? box.min.z() : box.max.z());
      const Vec3 p = project(c, x, aspect, 1);
      CHECK((p.x() > 0 && p.x() < aspect && p.y() > 0 && p.y() < 1 && p.z() > 0));
    }
  }
}

TEST_CASE("a framed box fills the picture in one direction and stands in its middle") {
  Random random(15);
  for (int i = 0; i < 200; ++i) {
    Aabb box;
    box.include(Vec3{random.uniform(-5, 0), random.uniform(-5, 0), random.uniform(-5, 0)});
    box.include(Vec3{random.uniform(0.01, 5), random.uniform(0.01, 5), random.uniform(0.01, 5)});
    const double aspect = random.uniform(0.4, 2.5);
    const Camera c = frame_bounds(
        box, Vec3{random.uniform(-1, 1), random.uniform(0.1, 1), random.uniform(-1, 1)}, 40,
        aspect);
    double left = 1, right = 0, top = 1, bottom = 0;
    for (int k = 0; k < 8; ++k) {
      const Vec3 x(k & 1 ? box.min.x() : box.max.x(), k & 2 ? box.min.y() : box.max.y(),
                   k & 4 ? box.min.z() : box.max.z());
      const Vec3 p = project(c, x, aspect, 1);
      left = std::min(left, p.x() / aspect);
      right = std::max(right, p.x() / aspect);
      top = std::min(top, p.y());
      bottom = std::max(bottom, p.y());
    }
    // The margin is a tenth of the box; in the direction that decides both sides are equal.
    constexpr double edge = 0.5 - 0.5 / 1.1;
    const bool wide = left < top;
    CHECK((wide ? left : top) == doctest::Approx(edge));
    CHECK((wide ? 1 - right : 1 - bottom) == doctest::Approx(edge));
    CHECK((left > edge - 1e-9 && 1 - right > edge - 1e-9));
    CHECK((top > edge - 1e-9 && 1 - bottom > edge - 1e-9));
  }
}

TEST_CASE("the frustum sees what projects into the picture") {
  Random random(6);
  int seen = 0;
  for (int i = 0; i < 2000; ++i) {
    const Camera c = random_camera(random);
    const Frustum f = frustum_of(perspective_matrix(c.fov_deg, 1.5, 0.5, 40) * view_matrix(c));
    const Vec3 x{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20)};
    const Vec3 p = project(c, x, 300, 200);
    const bool inside =
        p.z() > 0.5 && p.z() < 40 && p.x() > 0 && p.x() < 300 && p.y() > 0 && p.y() < 200;
    CHECK(f.sees_sphere(x, 0) == inside);
    if (inside) CHECK(f.sees_sphere(x, 2));
    seen += inside;
  }
  CHECK(seen > 300);
  CHECK(seen < 1700);
}
