// Time derivatives of what turns. Reference: central differences in fifty digits; resolution 1e-14
// of the result's size.
#include "engine/math/rotation_rates.hpp"

#include "engine/math/rotation.hpp"
#include "tests/support/precise_motion.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;

namespace {

Vec3 random_vector(Random& r) {
  const double x = r.uniform(-2, 2), y = r.uniform(-2, 2);
  return {x, y, r.uniform(-2, 2)};
}

/// Columns of the body's axes at time t.
Precise3 axis(const PreciseMotion& m, const Mat3& R, int column, const Precise& t) {
  return m.direction(R.col(column), t);
}

struct PreciseQuat {
  Precise c[4];  // w, x, y, z
  PreciseQuat operator-(const PreciseQuat& o) const {
    return {{c[0] - o.c[0], c[1] - o.c[1], c[2] - o.c[2], c[3] - o.c[3]}};
  }
  PreciseQuat operator*(const Precise& f) const {
    return {{c[0] * f, c[1] * f, c[2] * f, c[3] * f}};
  }
  Quat quat() const {
    return Quat(static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2]),
                static_cast<double>(c[3]));
  }
};

/// Orientation at time t: the exponential of the turn, times q.
PreciseQuat orientation(const PreciseMotion& m, const Quat& q, const Precise& t) {
  const Precise3 turn = precise(m.omega) * t + precise(m.alpha) * (t * t / 2);
  const Precise angle = length(turn);
  const Precise s = angle == 0 ? Precise(0.5) : Precise(sin(angle / 2) / angle), w = cos(angle / 2);
  const Precise3 u = turn * s, p = precise(q.vec());
  const Precise qw(q.w());
  const Precise3 v = p * w + u * qw + u.cross(p);
  return {{w * qw - u.dot(p), v.x, v.y, v.z}};
}

}  // namespace

TEST_CASE("rates of attached and carried vectors, matrices, tensors and quaternions") {
  Random r(71);
  for (int i = 0; i < 200; ++i) {
    const PreciseMotion m = PreciseMotion::random(r);
    const Vec3 v = random_vector(r);
    const auto attached = [&](const Precise& t) { return m.direction(v, t); };
    CHECK((attached_rate(v, m.omega) - rounded(central_rate(attached))).norm() < 1e-13);
    CHECK((attached_second_rate(v, m.omega, m.alpha) - rounded(central_second_rate(attached)))
              .norm() < 1e-12);

    // Seen from the body the vector is v + u t + w t^2 / 2.
    const Vec3 u = random_vector(r), w = random_vector(r);
    const auto carried = [&](const Precise& t) {
      return m.direction(v, t) + m.direction(u, t) * t + m.direction(w, t) * (t * t / 2);
    };
    CHECK((carried_rate(v, u, m.omega) - rounded(central_rate(carried))).norm() < 1e-13);
    CHECK((carried_second_rate(v, u, w, m.omega, m.alpha) - rounded(central_second_rate(carried)))
              .norm() < 1e-12);

    const Quat q = axis_angle(random_vector(r), r.uniform(-3, 3));
    const Mat3 R = q.toRotationMatrix();
    const Mat3 first = rotation_rate(R, m.omega),
               second = rotation_second_rate(R, m.omega, m.alpha);
    for (int c = 0; c < 3; ++c) {
      const auto column = [&](const Precise& t) { return axis(m, R, c, t); };
      CHECK((first.col(c) - rounded(central_rate(column))).norm() < 1e-13);
      CHECK((second.col(c) - rounded(central_second_rate(column))).norm() < 1e-12);
    }
    // A constant tensor in the body: its rate on a fixed vector.
    Mat3 half;
    for (int k = 0; k < 9; ++k) half(k % 3, k / 3) = r.uniform(-1, 1);
    const Mat3 body = half + half.transpose(), world = R * body * R.transpose();
    const auto applied = [&](const Precise& t) {
      Precise3 out{Precise(0), Precise(0), Precise(0)};
      for (int c = 0; c < 3; ++c) {
        for (int d = 0; d < 3; ++d) {
          out = out + axis(m, R, c, t) * (axis(m, R, d, t).dot(precise(v)) * Precise(body(c, d)));
        }
      }
      return out;
    };
    CHECK((inertia_rate(world, m.omega) * v - rounded(central_rate(applied))).norm() < 1e-12);

    const auto turned = [&](const Precise& t) { return orientation(m, q, t); };
    const Quat rate = quaternion_rate(q, m.omega);
    CHECK((rate.coeffs() - central_rate(turned).quat().coeffs()).norm() < 1e-14);
    CHECK((quaternion_second_rate(q, m.omega, m.alpha).coeffs() -
           central_second_rate(turned).quat().coeffs())
              .norm() < 1e-13);
    CHECK(std::fabs(q.dot(rate)) < 1e-15);
    CHECK((omega_of(q, rate) - m.omega).norm() < 1e-14);
  }
}

TEST_CASE("rates of directions and of the tangent frame") {
  Random r(72);
  for (int i = 0; i < 200; ++i) {
    const Vec3 v = random_vector(r), u = random_vector(r), w = random_vector(r);
    const auto direction = [&](const Precise& t) {
      return unit(precise(v) + precise(u) * t + precise(w) * (t * t / 2));
    };
    const double size = 1 + (u.norm() + w.norm()) / v.norm();
    CHECK((unit_vector_rate(v, u) - rounded(central_rate(direction))).norm() < 1e-14 * size);
    CHECK((unit_vector_second_rate(v, u, w) - rounded(central_second_rate(direction))).norm() <
          1e-13 * size * size);

    // tangent_frame() in fifty digits.
    const auto tangent = [&](int which) {
      return [&, which](const Precise& t) {
        const Precise3 n = direction(t);
        const auto axis7 = [](int x, int y, int z) {
          return Precise3{Precise(x) / 7, Precise(y) / 7, Precise(z) / 7};
        };
        const Precise3 a = axis7(3, -6, 2), b = axis7(6, 2, -3), c = axis7(2, 3, 6);
        const Precise x = n.dot(a), y = n.dot(b), k = 1 / (1 + n.dot(c));
        return which == 1 ? a * (1 - k * x * x) - b * (k * x * y) - c * x
                          : b * (1 - k * y * y) - a * (k * x * y) - c * y;
      };
    };
    const Vec3 n = v.normalized(), n_rate = unit_vector_rate(v, u);
    Vec3 t1, t2, d1, d2;
    tangent_frame(n, t1, t2);
    CHECK((t1 - rounded(tangent(1)(Precise(0)))).norm() < 1e-14);
    REQUIRE(tangent_frame_rate(n, n_rate, d1, d2));
    const double near_pole = 1 + 1 / (n + Vec3(2, 3, 6) / 7).norm();
    CHECK((d1 - rounded(central_rate(tangent(1)))).norm() < 1e-14 * size * near_pole * near_pole);
    CHECK((d2 - rounded(central_rate(tangent(2)))).norm() < 1e-14 * size * near_pole * near_pole);
    // A frame stays a frame.
    CHECK(std::fabs(t1.dot(d2) + t2.dot(d1)) < 1e-13 * size * near_pole);
    CHECK(std::fabs(n.dot(d1) + n_rate.dot(t1)) < 1e-13 * size * near_pole);
  }
  Vec3 d1, d2;
  CHECK(!tangent_frame_rate(-(Vec3(2, 3, 6) / 7), Vec3::Zero(), d1, d2));
}
