// Interpolation on great circles. References: turning at constant angular velocity (the exponential
// in axis-angle form) and Eigen's slerp.
#include "engine/math/slerp.hpp"

#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/rotation.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

int slerp_cases(int n) {
  return test::scaled_count(n);
}

Vec3 slerp_axis(Random& r) {
  for (;;) {
    const double x = r.uniform(-1, 1), y = r.uniform(-1, 1), z = r.uniform(-1, 1);
    const Vec3 v(x, y, z);
    if (v.norm() > 0.01 && v.norm() <= 1) return v.normalized();
  }
}

Eigen::Quaterniond eigen_quaternion(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

double apart(const Quat& a, const Quat& b) {
  return std::min((a.coeffs() - b.coeffs()).norm(), (a.coeffs() + b.coeffs()).norm());
}

}  // namespace

TEST_CASE("slerp turns at constant speed about one axis, at every angle") {
  Random r(8);
  for (int i = 0; i < slerp_cases(20000); ++i) {
    const Quat a = axis_angle(slerp_axis(r), r.uniform(-3, 3));
    const Vec3 axis = slerp_axis(r);
    const double angle = i % 2 ? r.uniform(0, 3.14) : std::pow(10.0, -r.uniform(0, 18));
    const Quat b = (axis_angle(axis, angle) * a).normalized();
    const double s = i % 10 == 0 ? 0 : i % 10 == 1 ? 1 : r.uniform();
    const Quat expected = axis_angle(axis, s * angle) * a;
    const Quat found = slerp(a, i % 3 ? b : Quat(-b.coeffs()), s);
    CHECK(apart(found, expected) < 1e-15);
    CHECK(std::fabs(found.norm() - 1) < 1e-15);
    const Eigen::Quaterniond theirs = eigen_quaternion(a).slerp(s, eigen_quaternion(b));
    const Quat by_eigen(theirs.w(), theirs.x(), theirs.y(), theirs.z());
    if (angle > 1e-3) CHECK(apart(found, by_eigen) < 1e-13);
    // What frames take instead is at most w^3 / 240 ahead or behind.
    if (angle < 1)
      CHECK(2 * apart(interpolate(a, b, s), expected) < angle * angle * angle / 230 + 2e-15);
  }
}

TEST_CASE("slerp of equal, opposite and half-turned orientations, and of poses") {
  const Quat a = axis_angle(Vec3(1, 2, 3), 0.7);
  CHECK(apart(slerp(a, a, 0.3), a) < 1e-16 * 4);
  CHECK(apart(slerp(a, Quat(-a.coeffs()), 0.3), a) < 1e-16 * 4);
  const Quat half = slerp(Quat::Identity(), Quat(0, 1, 0, 0), 0.5);
  CHECK(half.angularDistance(Quat::Identity()) == doctest::Approx(det::pi / 2));
  const Pose from{Vec3(1, 0, 0), a}, to{Vec3(3, 2, 0), Quat::Identity()};
  const Pose middle = slerp(from, to, 0.25);
  CHECK((middle.x - Vec3(1.5, 0.5, 0)).norm() < 1e-15);
  CHECK(apart(middle.q, axis_angle(Vec3(1, 2, 3), 0.7 * 0.75)) < 1e-15);
}
