// The fitted shadow map. Reference: points of the casters projected by the matrix itself.
#include "viewer/render/light_fit.hpp"

#include "engine/core/random.hpp"

#include <doctest/doctest.h>

using namespace tumble;

namespace {

Aabb box_of(const Vec3& a, const Vec3& b) {
  Aabb box;
  box.include(a);
  box.include(b);
  return box;
}

Mat4 wide_view(const Vec3& eye) {
  Camera c;
  c.eye = eye;
  c.target = Vec3::Zero();
  return perspective_matrix(100, 1.7, 0.1, 1000) * view_matrix(c);
}

}  // namespace

TEST_CASE("everything that casts and is seen lies in the map") {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const Aabb box = box_of(Vec3(-3, 0, -2), Vec3{random.uniform(0, 3), 4, random.uniform(0, 9)});
    const Vec3 sun{random.uniform(-1, 1), random.uniform(0.05, 1), random.uniform(-1, 1)};
    const LightFit f = fit_light(box, sun, wide_view(Vec3(0, 5, 40)), 1024);
    REQUIRE_FALSE(f.empty);
    for (int k = 0; k < 8; ++k) {
      const Vec4 p(k & 1 ? box.min.x() : box.max.x(), k & 2 ? box.min.y() : box.max.y(),
                   k & 4 ? box.min.z() : box.max.z(), 1);
      const Vec4 s = f.shadow_from_world * p;
      for (int axis = 0; axis < 3; ++axis) CHECK((s[axis] > 0 && s[axis] < 1));
    }
  }
}

TEST_CASE("depth grows away from the sun") {
  const LightFit f = fit_light(box_of(Vec3(-1, 0, -1), Vec3(1, 2, 1)), Vec3(0, 1, 0),
                               wide_view(Vec3(0, 5, 20)), 512);
  CHECK((f.shadow_from_world * Vec4(0, 2, 0, 1)).z() <
        (f.shadow_from_world * Vec4(0, 0, 0, 1)).z());
}

TEST_CASE("small movements keep the grid of texels in place") {
  const Vec3 sun(0.3, 0.8, 0.2);
  const auto fit = [&](double dx) {
    return fit_light(box_of(Vec3(-3 + dx, 0, -2), Vec3(3 + dx, 4, 2.5)), sun,
                     wide_view(Vec3(0, 5, 30)), 1024);
  };
  const LightFit a = fit(0);
  for (int i = 1; i < 40; ++i) {
    const LightFit b = fit(0.0137 * i);
    CHECK(b.texel == doctest::Approx(a.texel).epsilon(1e-12));
    const Vec4 shift = (b.shadow_from_world.col(3) - a.shadow_from_world.col(3)) * 1024;
    CHECK(std::fabs(shift.x() - std::round(shift.x())) < 1e-6);
    CHECK(std::fabs(shift.y() - std::round(shift.y())) < 1e-6);
  }
}

TEST_CASE("no casters, no map, a distant rest does not spoil the near part") {
  CHECK(fit_light({}, Vec3::UnitY(), wide_view(Vec3(0, 5, 20)), 512).empty);
  Camera c;
  c.eye = Vec3(0, 3, 8);
  c.target = Vec3::Zero();
  const Mat4 near_view = perspective_matrix(40, 1.7, 0.1, 30) * view_matrix(c);
  const LightFit f = fit_light(box_of(Vec3(-1000, 0, -1000), Vec3(1000, 5, 1000)), Vec3(0, 1, 0.2),
                               near_view, 1024);
  CHECK(f.texel < 0.06);
}

TEST_CASE("the ground's contact map covers what stands on it") {
  const ContactFit f = fit_contact(box_of(Vec3(-3, 0, -1), Vec3(5, 2, 2)), Vec3::Zero(), 12, 128);
  CHECK(f.x0 < -3);
  CHECK(f.x0 + f.side > 5);
  CHECK(f.z0 < -1);
  CHECK(f.z0 + f.side > 2);
}
