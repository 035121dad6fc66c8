// Rotations. References: Eigen's own constructions, algebraic identities, and the closed form of
// rotation at constant angular velocity.
#include "engine/math/rotation.hpp"

#include "engine/core/random.hpp"
#include "engine/math/dense.hpp"
#include "engine/math/det/det.hpp"
#include "tests/support/scale.hpp"

#include <cmath>
#include <cstdlib>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

int count(int n) {
  return test::scaled_count(n);
}

Vec3 vector(Random& r, double half = 1) {
  const double x = r.uniform(-half, half), y = r.uniform(-half, half), z = r.uniform(-half, half);
  return {x, y, z};
}

Vec3 direction(Random& r) {
  for (;;) {
    const Vec3 v = vector(r);
    if (v.norm() > 0.01 && v.norm() <= 1) return v.normalized();
  }
}

Quat rotation(Random& r) {
  return axis_angle(direction(r), r.uniform(-3, 3));
}

Eigen::Quaterniond by_eigen(const Quat& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Quaterniond turn_by_eigen(const Vec3& axis, double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, dense(axis)));
}

Quat ours(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

/// The direction at which tangent_frame jumps.
const Vec3 tangent_pole = -Vec3(2, 3, 6) / 7;

/// Angle of the rotation between two orientations [rad].
double angle_between(const Quat& a, const Quat& b) {
  return 2 * (a.conjugate() * b).vec().norm();  // small angles
}

}  // namespace

TEST_CASE("the cross-product matrix is the cross product") {
  Random random(1);
  for (int i = 0; i < count(1000); ++i) {
    const Vec3 a = vector(random), b = vector(random);
    CHECK(skew(a) * b == a.cross(b));
    CHECK(skew(a).transpose() == -skew(a));
  }
}

TEST_CASE("axis and angle, Euler angles: as Eigen's") {
  Random random(2);
  for (int i = 0; i < count(10000); ++i) {
    const Vec3 axis = direction(random) * random.uniform(0.1, 10);
    const double angle = random.uniform(-7, 7);
    const Quat expected = ours(turn_by_eigen(axis.normalized(), angle));
    CHECK((axis_angle(axis, angle).coeffs() - expected.coeffs()).norm() < 1e-15);
    const Vec3 e = vector(random, 4);
    const Mat3 m =
        small_matrix((turn_by_eigen(Vec3::UnitX(), e.x()) * turn_by_eigen(Vec3::UnitY(), e.y()) *
                      turn_by_eigen(Vec3::UnitZ(), e.z()))
                         .toRotationMatrix());
    CHECK((euler_xyz(e).toRotationMatrix() - m).norm() < 1e-14);
  }
  CHECK(axis_angle(Vec3::Zero(), 1).coeffs() == Quat::Identity().coeffs());
}

TEST_CASE("quaternion identities: product turns in sequence, conjugate inverts, norm is kept") {
  Random random(3);
  for (int i = 0; i < count(10000); ++i) {
    const Quat a = rotation(random), b = rotation(random);
    const Vec3 v = vector(random);
    CHECK(((a * b) * v - a * (b * v)).norm() < 1e-15 * 4);
    CHECK((a.conjugate() * (a * v) - v).norm() < 1e-15 * 4);
    CHECK(std::fabs((a * v).norm() - v.norm()) < 1e-15 * 4);
    CHECK(((a * b).conjugate().coeffs() - (b.conjugate() * a.conjugate()).coeffs()).norm() < 1e-15);
    // Rodrigues: v cos + (k x v) sin + k (k.v)(1 - cos).
    const Vec3 k = direction(random);
    const double t = random.uniform(-3, 3);
    const Vec3 turned =
        v * std::cos(t) + k.cross(v) * std::sin(t) + k * k.dot(v) * (1 - std::cos(t));
    CHECK((axis_angle(k, t) * v - turned).norm() < 1e-15 * 8);
  }
}

TEST_CASE("quaternion identities: products by components, inverse, conjugates of sums, sandwich") {
  // (s1, v1)(s2, v2) = (s1 s2 - v1.v2, s1 v2 + s2 v1 + v1 x v2), for any quaternions.
  Random random(31);
  for (int i = 0; i < count(10000); ++i) {
    const auto any = [&] {
      const Vec3 v = vector(random);
      return Quat(random.uniform(-1, 1), v.x(), v.y(), v.z());
    };
    const Quat a = any(), b = any(), c = any(), ab = a * b;
    CHECK(std::fabs(ab.w() - (a.w() * b.w() - a.vec().dot(b.vec()))) < 1e-15 * 2);
    const Vec3 v = a.w() * b.vec() + b.w() * a.vec() + a.vec().cross(b.vec());
    CHECK((ab.vec() - v).norm() < 1e-15 * 4);
    CHECK(((ab * c).coeffs() - (a * (b * c)).coeffs()).norm() < 1e-14);  // associative
    const Quat sum(Vec4(b.coeffs() + c.coeffs()));
    CHECK(((a * sum).coeffs() - ab.coeffs() - (a * c).coeffs()).norm() < 1e-14);  // distributive
    CHECK((ab.conjugate().coeffs() - (b.conjugate() * a.conjugate()).coeffs()).norm() < 1e-14);
    CHECK(std::fabs(ab.norm() - a.norm() * b.norm()) < 1e-14);
    CHECK(((a * a.conjugate()).coeffs() - Vec4(0, 0, 0, a.squaredNorm())).norm() < 1e-14);
    if (a.norm() > 0.1) CHECK(((a * a.inverse()).coeffs() - Vec4(0, 0, 0, 1)).norm() < 1e-13);
    // q (0, p) q* = (0, R(q) p), and q and -q turn alike.
    const Quat q = rotation(random);
    const Vec3 p = vector(random);
    const Quat turned = q * Quat(0, p.x(), p.y(), p.z()) * q.conjugate();
    CHECK(std::fabs(turned.w()) < 1e-15);
    CHECK((turned.vec() - q.toRotationMatrix() * p).norm() < 1e-15 * 4);
    CHECK(Quat(-q.coeffs()).toRotationMatrix() == q.toRotationMatrix());
    // R(q) = (s^2 - v.v) I + 2 v v^T + 2 s skew(v).
    const Vec3 u = q.vec();
    const Mat3 m =
        (q.w() * q.w() - u.dot(u)) * Mat3::Identity() + 2 * u * u.transpose() + 2 * q.w() * skew(u);
    CHECK((m - q.toRotationMatrix()).norm() < 1e-15 * 4);
  }
}

TEST_CASE("poses compose, invert and map back") {
  Random random(4);
  for (int i = 0; i < count(10000); ++i) {
    const Pose a{vector(random, 5), rotation(random)}, b{vector(random, 5), rotation(random)};
    const Vec3 p = vector(random, 5);
    CHECK(((a * b).point(p) - a.point(b.point(p))).norm() < 3e-14);
    CHECK((a.inverse_point(a.point(p)) - p).norm() < 3e-14);
    CHECK((a.inverse().point(a.point(p)) - p).norm() < 3e-14);
    CHECK((a.inverse_direction(a.direction(p)) - p).norm() < 3e-14);
  }
}

TEST_CASE("turning at constant angular velocity is exact for any step and adds up") {
  Random random(5);
  for (int i = 0; i < count(2000); ++i) {
    const Quat q = rotation(random);
    const Vec3 omega = direction(random) * std::pow(10.0, random.uniform(-8, 3));
    const double h = random.uniform(1e-4, 0.1);
    const Quat exact = ours(turn_by_eigen(omega.normalized(), omega.norm() * h)) * q;
    CHECK(angle_between(integrate_rotation(q, omega, h), exact) < 1e-15 * 8);
    Quat steps = q;
    for (int k = 0; k < 16; ++k) steps = integrate_rotation(steps, omega, h / 16);
    CHECK(angle_between(steps, exact) < 1e-13);
    CHECK(std::fabs(steps.norm() - 1) < 1e-15 * 4);
  }
  CHECK(integrate_rotation(Quat::Identity(), Vec3::Zero(), 1).coeffs() ==
        Quat::Identity().coeffs());
}

TEST_CASE("interpolation takes the shortest way and ends where it should") {
  Random random(6);
  for (int i = 0; i < count(5000); ++i) {
    const Quat a = rotation(random);
    Quat b = rotation(random);
    CHECK((interpolate(a, b, 0).coeffs() - a.coeffs()).norm() < 1e-15 * 2);
    CHECK(angle_between(interpolate(a, b, 1), b.dot(a) < 0 ? Quat(-b.coeffs()) : b) < 1e-15 * 4);
    const Quat middle = interpolate(a, b, 0.5);
    CHECK((interpolate(a, Quat(-b.coeffs()), 0.5).coeffs() - middle.coeffs()).norm() < 1e-15 * 2);
    CHECK((middle.coeffs() - ours(by_eigen(a).slerp(0.5, by_eigen(b))).coeffs()).norm() < 1e-14);
    // Off the middle it is slower or faster than slerp, but on the same arc.
    const Quat s = interpolate(a, b, 0.3);
    CHECK(std::fabs(s.norm() - 1) < 1e-15 * 4);
    CHECK(s.angularDistance(a) < b.angularDistance(a) + 1e-12);
  }
  CHECK(interpolate(Quat(1, 0, 0, 0), Quat(0, 1, 0, 0), 0.5).angularDistance(Quat::Identity()) ==
        doctest::Approx(det::pi / 2));
}

TEST_CASE("shortest rotation between two directions, opposite ones included") {
  Random random(7);
  for (int i = 0; i < count(20000); ++i) {
    const Vec3 a = direction(random);
    Vec3 b = direction(random);
    if (i % 4 == 1) b = -a;
    if (i % 4 == 2) b = (-a + 1e-7 * direction(random)).normalized();
    if (i % 4 == 3) b = (a + 1e-9 * direction(random)).normalized();
    const Quat q = rotation_between(a, b);
    CHECK(std::fabs(q.norm() - 1) < 1e-15 * 4);
    CHECK((q * a - b).norm() < (i % 4 == 2 ? 2e-7 : 1e-15 * 8));
  }
}

TEST_CASE("tangent frames are orthonormal and right-handed in every direction") {
  Random random(8);
  for (int i = 0; i < count(100000); ++i) {
    Vec3 n = direction(random);
    if (i % 8 == 1) n = Vec3::Unit(i / 8 % 3) * (i % 16 == 1 ? 1 : -1);
    if (i % 8 == 2) n = Vec3(1e-9 * n.x(), 1e-9 * n.y(), n.z() > 0 ? 1 : -1).normalized();
    if (i % 8 == 3) n = Vec3(n.x(), n.y(), 0).normalized();
    if (i % 8 == 4) n = Vec3(n.x(), n.y(), -1e-300).normalized();
    if (i % 8 == 5) n = (tangent_pole + std::pow(10.0, random.uniform(-20, 0)) * n).normalized();
    if (i % 8 == 6) n = tangent_pole;
    Vec3 t1, t2;
    tangent_frame(n, t1, t2);
    const Mat3 m = Mat3::from_columns(t1, t2, n);
    CHECK((m.transpose() * m - Mat3::Identity()).norm() < 1e-15 * 4);
    CHECK((t1.cross(t2) - n).norm() < 1e-15 * 4);
  }
}

TEST_CASE("neighbouring normals have neighbouring tangent frames, but at one direction") {
  Random random(9);
  int near_pole = 0;
  for (int i = 0; i < count(100000); ++i) {
    Vec3 n = direction(random);
    if (i % 4 == 1) n = Vec3::Unit(i / 4 % 3) * (i % 8 == 1 ? 1 : -1);
    if (i % 4 == 2) n[i / 4 % 3] = 0, n.normalize();
    if (i % 4 == 3) n = (tangent_pole + std::pow(10.0, random.uniform(-6, 0)) * n).normalized();
    const double from_pole = (n - tangent_pole).norm();
    const double d = std::pow(10.0, random.uniform(-12, -1)) * std::min(1.0, from_pole);
    const Vec3 m = (n + d * direction(random)).normalized();
    Vec3 t1, t2, u1, u2;
    tangent_frame(n, t1, t2);
    tangent_frame(m, u1, u2);
    near_pole += from_pole < 0.1;
    CHECK((t1 - u1).norm() <= 4 * d / from_pole + 4e-15 / from_pole);
    CHECK((t2 - u2).norm() <= 4 * d / from_pole + 4e-15 / from_pole);
  }
  CHECK(near_pole > count(100000) / 10);
}

TEST_CASE("the angles of a rotation make it again, at a quarter turn too") {
  Random random(77);
  for (int i = 0; i < count(10000); ++i) {
    const Quat q = rotation(random);
    const Vec3 a = angles_xyz(q);
    CHECK(std::fabs(a.y()) <= M_PI / 2 + 1e-15);
    CHECK((euler_xyz(a).toRotationMatrix() - q.toRotationMatrix()).norm() < 1e-14);
    // Where the second is a quarter turn, or nearly, the others are not told apart.
    const Vec3 asked(random.uniform(-3, 3), (i % 2 ? 1 : -1) * (M_PI / 2 - (i % 3) * 1e-9),
                     random.uniform(-3, 3));
    const Quat edge = euler_xyz(asked);
    CHECK((euler_xyz(angles_xyz(edge)).toRotationMatrix() - edge.toRotationMatrix()).norm() <
          1e-14);
    // Inside, the angles are those that were asked for.
    const Vec3 inner(asked.x(), random.uniform(-1.5, 1.5), asked.z());
    CHECK((angles_xyz(euler_xyz(inner)) - inner).norm() < 1e-13);
  }
}
