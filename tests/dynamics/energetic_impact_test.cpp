// One frictional collision. References: the closed form of a sphere; Stronge's closed form in the
// plane, worked out here piece by piece over the normal impulse in long double; and for slip that
// turns a march in 400,000 equal pieces of the normal impulse (resolution 1e-5).
#include "engine/dynamics/event/impulses/energetic_impact.hpp"

#include "engine/core/random.hpp"
#include "tests/support/scale.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Mobility of a body struck at `arm` from its centre, in the frame (normal x, tangents y, z).
Mat3 mobility_of(double mass, const Mat3& inertia, const Vec3& arm) {
  const Mat3 cross(0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0);
  return Mat3::Identity() / mass - cross * inertia.inverse() * cross;
}

Mat3 random_mobility(Random& r) {
  const Vec3 sides(r.uniform(0.1, 1), r.uniform(0.1, 1), r.uniform(0.1, 1));
  const double m = r.uniform(0.5, 2);
  const Vec3 I = m / 3 *
                 Vec3(sides.y() * sides.y() + sides.z() * sides.z(),
                      sides.x() * sides.x() + sides.z() * sides.z(),
                      sides.x() * sides.x() + sides.y() * sides.y());
  Quat q(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1));
  q.normalize();
  const Mat3 R = q.toRotationMatrix();
  const Vec3 corner = R * Vec3(sides.x(), sides.y(), sides.z());
  return mobility_of(m, R * I.asDiagonal() * R.transpose(), corner);
}

double energy_change(const PointImpact& in, const PointImpactResult& out) {
  return out.impulse.dot(in.velocity + 0.5 * in.mobility * out.impulse);
}

/// Stronge's law in the plane: sliding, sticking or reversed slip, each with constant rates.
struct PlaneResult {
  long double pn = 0, pt = 0;
};
PlaneResult plane_impact(long double knn, long double knt, long double ktt, long double un,
                         long double ut, long double mu, long double e) {
  PlaneResult r;
  long double work = 0, lowest = 0;
  bool out = false, rest = ut == 0;
  int side = ut > 0 ? 1 : -1;
  for (int piece = 0; piece < 20; ++piece) {
    long double f = -mu * side;  // tangential per normal impulse
    if (rest) {
      const long double hold = -knt / ktt;
      f = std::fabs(hold) <= mu ? hold : (knt > 0 ? -mu : mu);
    }
    const long double a = knn + knt * f, b = knt + ktt * f;
    long double slip_end = 1e30L, event = 1e30L;
    if (!rest && ut * b < 0) slip_end = -ut / b;
    if (!out && un < 0 && a > 0) event = -un / a;
    if (out) {
      const long double missing = lowest * (1 - e * e) - work, root = un * un + 2 * a * missing;
      if (root >= 0) event = 2 * missing / (un + std::sqrt(root));
    }
    const long double go = std::min(slip_end, event);
    work += go * (un + a * go / 2);
    un += a * go, ut += b * go, r.pn += go, r.pt += f * go;
    if (slip_end <= event) {
      rest = true, ut = 0;
    } else if (out) {
      return r;
    } else {
      out = true, lowest = work;
      if (e == 0) return r;
    }
  }
  FAIL("the reference did not end");
  return r;
}

}  // namespace

TEST_CASE("a sphere slides through or sticks as the closed form says") {
  Random r(3);
  int stuck = 0;
  for (int i = 0; i < 1000; ++i) {
    const double m = r.uniform(0.1, 10), radius = r.uniform(0.1, 2), e = r.uniform();
    PointImpact in;
    in.mobility = mobility_of(m, 0.4 * m * radius * radius * Mat3::Identity(), {-radius, 0, 0});
    in.velocity = Vec3(-r.uniform(0.1, 5), r.uniform(-5, 5), r.uniform(-5, 5));
    in.friction = r.uniform(0, 1);
    in.restitution = e;
    const PointImpactResult out = energetic_impact(in);
    REQUIRE(out.status == PointImpactStatus::solved);
    const Vec2 slip = in.velocity.tail<2>();
    const double pn = -(1 + e) * in.velocity.x() * m;
    // 1/m + r^2/I = 7/(2m)
    const double needed = slip.norm() * m * 2 / 7, bound = in.friction * pn;
    const Vec2 pt = -slip / slip.norm() * std::min(needed, bound);
    CHECK(out.impulse.x() == doctest::Approx(pn).epsilon(1e-13));
    CHECK((out.impulse.tail<2>() - pt).norm() < 1e-12 * pn);
    CHECK(out.stuck == (needed <= bound));
    stuck += out.stuck;
  }
  CHECK(stuck > 250);
  CHECK(stuck < 750);
}

TEST_CASE("in the plane it is Stronge's closed form: sliding, sticking, reversed, jammed") {
  Random r(4);
  int sticks = 0, reverses = 0, slides = 0;
  for (int i = 0; i < 20000; ++i) {
    const double angle = r.uniform(-1.5, 1.5), mass = r.uniform(0.2, 5), half = r.uniform(0.1, 2);
    const double inertia = mass * half * half / 3;
    const Vec3 arm(-half * std::cos(angle), half * std::sin(angle), 0);  // a rod on its end
    PointImpact in;
    in.mobility = mobility_of(mass, inertia * Mat3::Identity(), arm);
    in.velocity = {-r.uniform(0.1, 3), r.uniform(-3, 3), 0};
    if (i % 10 == 0) in.velocity.y() = 0;
    in.friction = r.uniform(0, 1.5);
    in.restitution = i % 5 == 0 ? 0 : r.uniform(0, 1);
    const Mat3& K = in.mobility;
    const PointImpactResult out = energetic_impact(in);
    REQUIRE(out.status == PointImpactStatus::solved);
    const PlaneResult want = plane_impact(K(0, 0), K(0, 1), K(1, 1), in.velocity.x(),
                                          in.velocity.y(), in.friction, in.restitution);
    const double scale = double(want.pn);
    CHECK(std::fabs(out.impulse.x() - double(want.pn)) < 1e-11 * scale);
    CHECK(std::fabs(out.impulse.y() - double(want.pt)) < 1e-11 * scale);
    CHECK(std::fabs(out.impulse.z()) < 1e-14 * scale);
    CHECK(energy_change(in, out) <= 1e-13);
    sticks += out.stuck, reverses += out.reversed, slides += !out.stuck && !out.reversed;
  }
  CHECK(sticks > 2000);
  CHECK(reverses > 500);
  CHECK(slides > 2000);
}

TEST_CASE("slip that turns follows Routh's equations") {
  Random r(5);
  for (int i = 0; i < 40; ++i) {
    PointImpact in;
    in.mobility = random_mobility(r);
    in.velocity = Vec3(-1, r.uniform(-2, 2), r.uniform(-2, 2));
    in.friction = r.uniform(0.05, 0.4);
    in.restitution = r.uniform(0.1, 0.9);
    const PointImpactResult out = energetic_impact(in);
    REQUIRE(out.status == PointImpactStatus::solved);
    if (out.stuck || out.reversed) continue;
    // march to the same normal impulse
    Vec3 p = Vec3::Zero();
    double work = 0, lowest = 0;
    constexpr int pieces = 400000;
    const double dp = out.impulse.x() / pieces;
    for (int k = 0; k < pieces; ++k) {
      const Vec3 u = in.velocity + in.mobility * p;
      const Vec2 s = u.tail<2>().normalized();
      const Vec3 half = p + 0.5 * dp * Vec3(1, -in.friction * s.x(), -in.friction * s.y());
      const Vec3 v = in.velocity + in.mobility * half;
      const Vec2 t = v.tail<2>().normalized();
      p += dp * Vec3(1, -in.friction * t.x(), -in.friction * t.y());
      work += dp * v.x();
      lowest = std::min(lowest, work);
    }
    CHECK((p - out.impulse).norm() < 1e-5 * p.norm());
    CHECK(work == doctest::Approx(lowest * (1 - in.restitution * in.restitution)).epsilon(1e-4));
    CHECK(lowest == doctest::Approx(out.compression_work).epsilon(1e-5));
  }
}

TEST_CASE("any collision: the energetic law holds, friction takes energy, the cone is kept") {
  Random r(6);
  const int draws = test::graded_count(20000, 20000, 1000);
  int stuck = 0, reversed = 0, most = 0;
  for (int i = 0; i < draws; ++i) {
    PointImpact in;
    in.mobility = random_mobility(r);
    in.velocity = Vec3(-r.uniform(0.01, 3), r.uniform(-2, 2), r.uniform(-2, 2));
    in.friction = r.uniform(0, 2);
    in.restitution = i % 7 == 0 ? 1 : i % 7 == 1 ? 0 : r.uniform();
    const PointImpactResult out = energetic_impact(in);
    REQUIRE(out.status == PointImpactStatus::solved);
    const double size = 0.5 * in.velocity.squaredNorm() / in.mobility(0, 0);
    const double normal_work = energy_change(in, out) - out.friction_work;
    CHECK(std::fabs(normal_work - out.compression_work * (1 - in.restitution * in.restitution)) <
          1e-12 * size);
    CHECK(out.friction_work <= 1e-12 * size);
    CHECK(out.impulse.tail<2>().norm() <= in.friction * out.impulse.x() * (1 + 1e-12));
    CHECK(out.velocity.x() >= -1e-13 * in.velocity.norm());
    if (out.stuck) CHECK(out.velocity.tail<2>().norm() < 1e-12 * in.velocity.norm());
    stuck += out.stuck, reversed += out.reversed, most = std::max(most, out.steps);
  }
  CHECK(stuck > draws / 5);
  CHECK(reversed > draws / 400);
  CHECK(most < 4000);  // where slip whirls to its rest
}

TEST_CASE("what is no collision gets an answer too") {
  PointImpact in;
  in.velocity = {1, 1, 0};
  CHECK(energetic_impact(in).status == PointImpactStatus::separating);
  in.velocity = {0, 1, 0};
  CHECK(energetic_impact(in).impulse.isZero());
  in.velocity = {-1, std::nan(""), 0};
  CHECK(energetic_impact(in).status == PointImpactStatus::invalid);
  in.velocity = {-1, 0, 0};
  in.mobility.setZero();
  CHECK(energetic_impact(in).status == PointImpactStatus::invalid);
  in.mobility.setZero();
  in.mobility(0, 0) = 2;  // nothing moves sideways
  in.velocity = {-1, 3, 0};
  in.friction = 0.5;
  in.restitution = 1;
  CHECK(energetic_impact(in).velocity.x() == doctest::Approx(1));
}
