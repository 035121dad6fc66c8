// Mechanisms that others publish, under the event stepper. References: Andrews' squeezer of the IVP
// test set (Mazzia and Magherini 2008); N four-bars and Bricard's mechanism of the IFToMM library
// of benchmarks (Gonzalez et al. 2006), the former also as the pendulum that it is; its spatial
// slider-crank (Haug 1989, section 12.2), also by quadrature of its one freedom; conservation of
// energy; the rimless wheel's steady gait (McGeer 1990).
#include "engine/math/rotation.hpp"
#include "tests/dynamics/event_world.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/spatial_slider_crank.hpp"

#include <cmath>
#include <numbers>

using namespace tumble;
using namespace tumble::test;

namespace {

constexpr double g = 9.81;

Quat turned(double angle) {
  return axis_angle(Vec3::UnitZ(), angle);
}

/// Bodies that are nothing but mass, in planar hinges unless said otherwise.
struct Mechanism : EventWorld {
  using EventWorld::EventWorld;
  uint32_t lump(const Vec3& x, double angle, double mass, const Vec3& inertia) {
    BodyDef d;
    d.pose = {x, turned(angle)};
    d.mass = mass;
    d.inertia = inertia;
    return add(d);
  }
  /// A uniform rod of 1 kg/m between two points.
  uint32_t rod(const Vec3& a, const Vec3& b) {
    const double length = (b - a).norm(), across = length * length * length / 12;
    BodyDef d;
    d.pose = {0.5 * (a + b), rotation_between(Vec3::UnitX(), (b - a).normalized())};
    d.mass = length;
    d.inertia = Vec3(1e-3 * across, across, across);
    return add(d);
  }
  void hinge(uint32_t a, uint32_t b, const Vec3& x, const Vec3& axis = Vec3::UnitZ()) {
    join(JointKind::revolute, a, b, {x, rotation_between(Vec3::UnitZ(), axis.normalized())});
  }
  double angle(uint32_t body) const {
    const Vec3 x = bodies[body].pose.q * Vec3::UnitX();
    return std::atan2(x.y(), x.x());
  }
};

/// Seven bodies in a plane, of some millimetres and grams, driven to 1000 rad/s.
struct Squeezer : Mechanism {
  static constexpr double xa = -.06934, ya = -.00227, xb = -.03635, yb = .03273, xc = .014,
                          yc = .072, c0 = 4530, l0 = .07785, drive = .033;
  static constexpr double d = .028, da = .0115, e = .02, ea = .01421, rr = .007, ra = .00092,
                          ss = .035, sa = .01874, sb = .01043, sc = .018, sd = .02, ta = .02308,
                          tb = .00916, u = .04, ua = .01228, ub = .00449, zf = .02, zt = .04,
                          fa = .01421;

  explicit Squeezer(double hz) : Mechanism(hz) {
    gravity.setZero();
    const double beta = -0.0617138900142764496, theta = 0, gamma = 0.455279819163070380,
                 phi = 0.222668390165885885, delta = 0.487364979543842550,
                 omega = -0.222668390165885885, epsilon = 1.23054744454982119;
    const Vec3 O(0, 0, 0), A(xa, ya, 0), B(xb, yb, 0);
    const Quat q1 = turned(beta), q2 = turned(beta + theta), q3 = turned(gamma),
               q4 = turned(phi + delta), q5 = turned(delta), q6 = turned(omega + epsilon),
               q7 = turned(epsilon);
    const Vec3 F = q1 * Vec3(rr, 0, 0), E = F - q2 * Vec3(d, 0, 0), G = A + q5 * Vec3(zt, 0, 0),
               H = A - q7 * Vec3(0, u, 0);
    // It closes.
    REQUIRE((E - (B - q3 * Vec3(0, ss, 0))).norm() < 1e-13);
    REQUIRE((E - (G - q4 * Vec3(0, e, 0))).norm() < 1e-13);
    REQUIRE((E - (H + q6 * Vec3(zf, 0, 0))).norm() < 1e-13);
    const auto plate = [this](const Vec3& x, double turn, double mass, double inertia) {
      lump(x, turn, mass, Vec3::Constant(inertia));
    };
    plate(q1 * Vec3(ra, 0, 0), beta, .04325, 2.194e-6);
    plate(F - q2 * Vec3(da, 0, 0), beta + theta, .00365, 4.410e-7);
    plate(B + q3 * Vec3(sb, -sa, 0), gamma, .02373, 5.255e-6);
    plate(G - q4 * Vec3(0, e - ea, 0), phi + delta, .00706, 5.667e-7);
    plate(A + q5 * Vec3(ta, tb, 0), delta, .07050, 1.169e-5);
    plate(H + q6 * Vec3(zf - fa, 0, 0), omega + epsilon, .00706, 5.667e-7);
    plate(A - q7 * Vec3(ub, ua, 0), epsilon, .05498, 1.912e-5);
    hinge(no_body, 0, O), hinge(0, 1, F), hinge(1, 2, E), hinge(1, 3, E), hinge(1, 5, E);
    hinge(no_body, 2, B), hinge(3, 4, G), hinge(no_body, 4, A), hinge(5, 6, H);
    hinge(no_body, 6, A);
    extra_force = [](uint32_t slot, RigidBody& b) {
      if (slot == 0) b.torque.z() += drive;
      if (slot != 2) return;
      const Vec3 arm = b.pose.q * Vec3(sd - sb, sa - sc, 0), D = b.pose.x + arm;
      const Vec3 stretch = D - Vec3(xc, yc, 0);
      const double length = stretch.norm();
      const Vec3 force = -c0 * (length - l0) / length * stretch;
      b.force += force;
      b.torque += arm.cross(force);
    };
  }
};

/// N squares of rods in a row, upright on hinges, that fall over together: one freedom, and where
/// the rods lie flat many more.
struct FourBars : Mechanism {
  int squares;
  FourBars(double hz, int n) : Mechanism(hz), squares(n) {
    for (int i = 0; i <= n; ++i) {
      const auto x = double(i);
      const uint32_t upright = rod({x, 0, 0}, {x, 1, 0});
      bodies[upright].v = {0.5, 0, 0};
      bodies[upright].omega = {0, 0, -1};
      hinge(no_body, upright, {x, 0, 0});
    }
    for (int i = 0; i < n; ++i) {
      const auto x = double(i);
      const uint32_t beam = rod({x, 1, 0}, {x + 1, 1, 0});
      bodies[beam].v = {1, 0, 0};
      hinge(uint32_t(i), beam, {x, 1, 0});
      hinge(uint32_t(i + 1), beam, {x + 1, 1, 0});
    }
  }
  /// The far end of the first upright rod.
  Vec3 top() const { return bodies[0].pose.x + bodies[0].pose.q * Vec3(0.5, 0, 0); }
  /// The same of the pendulum that it is: its way round from upright, by small steps of the fourth
  /// order.
  Vec3 top_of_pendulum(double seconds) const {
    const double inertia = (squares + 1) / 3.0 + squares, moment = (squares + 1) / 2.0 + squares;
    double angle = 0, rate = 1;
    const int steps = 20000;
    const double s = seconds / steps;
    const auto speed_up = [&](double a) { return g * moment / inertia * std::sin(a); };
    for (int i = 0; i < steps; ++i) {
      const double a1 = rate, b1 = speed_up(angle), a2 = rate + s / 2 * b1,
                   b2 = speed_up(angle + s / 2 * a1), a3 = rate + s / 2 * b2,
                   b3 = speed_up(angle + s / 2 * a2), a4 = rate + s * b3,
                   b4 = speed_up(angle + s * a3);
      angle += s / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      rate += s / 6 * (b1 + 2 * b2 + 2 * b3 + b4);
    }
    return {std::sin(angle), std::cos(angle), 0};
  }
};

/// Five rods along the edges of a cube from vertex to vertex, the sixth edge being the world.
struct Bricard : Mechanism {
  explicit Bricard(double hz) : Mechanism(hz) {
    const std::array<Vec3, 6> corners{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                      Vec3(1, 1, 1), Vec3(0, 1, 1), Vec3(0, 0, 1)};
    for (size_t i = 0; i < 5; ++i) {
      const uint32_t made = rod(corners[i], corners[i + 1]);
      hinge(i == 0 ? no_body : made - 1, made, corners[i], Vec3::Unit((int(i) + 1) % 3));
    }
    hinge(no_body, 4, corners[5], Vec3::UnitX());
  }
};

/// Its bodies and joints.
struct SpatialSliderCrank : Mechanism, SpatialSliderCrankReference {
  explicit SpatialSliderCrank(double hz) : Mechanism(hz) {
    gravity = {0, 0, -g};
    const Vec3 A(0, side, height), B = A + Vec3(0, 0, crank), C(.2, 0, 0), X = Vec3::UnitX();
    REQUIRE((C - B).norm() == doctest::Approx(rod_length).epsilon(1e-15));
    const Vec3 along = (C - B) / rod_length, across = X.cross(along).normalized();
    const uint32_t arm = lump(0.5 * (A + B), 0, crank_mass, {crank_inertia, crank_inertia, 1e-5});
    const uint32_t link = lump(0.5 * (B + C), 0, rod_mass, {rod_spin, rod_inertia, rod_inertia});
    bodies[link].pose.q = Quat(Mat3::from_columns(along, across, along.cross(across)));
    const uint32_t slider = lump(C, 0, slider_mass, Vec3::Constant(1e-4));
    bodies[arm].omega = {start_rate, 0, 0};
    bodies[arm].v = bodies[arm].omega.cross(0.5 * (B - A));
    // What goes with that: the ends of the rod move by these, and it does not turn about x.
    const Vec3 of_b = bodies[arm].omega.cross(B - A), of_c(.24, 0, 0);
    bodies[link].v = 0.5 * (of_b + of_c);
    bodies[link].omega = {1.92, -.96, .48};
    REQUIRE((of_b + bodies[link].omega.cross(C - B) - of_c).norm() < 1e-14);
    bodies[slider].v = of_c;
    hinge(no_body, arm, A, X);
    join(JointKind::spherical, arm, link, {B, Quat::Identity()});
    join(JointKind::universal, slider, link,
         {C, Quat(Mat3::from_columns(across, X.cross(across), X))});
    join(JointKind::prismatic, no_body, slider, {C, rotation_between(Vec3::UnitZ(), X)});
  }
  double crank_angle() const { return 2 * std::atan2(bodies[0].pose.q.x(), bodies[0].pose.q.w()); }
};

}  // namespace

TEST_CASE("Andrews' squeezer ends where the IVP test set says") {
  Squeezer w(20000);
  w.run(only_to_run() ? 0.001 : 0.03);
  CHECK(w.joint_error() < 1e-12);
  if (only_to_run()) return;
  const double beta = 15.81077119629904, theta = -15.75637105984298, gamma = .04082224013073101,
               phi = -.5347301163226948, delta = .5244099658805304, omega = .5347301163226948,
               epsilon = 1.048080741042263;
  const std::array<double, 7> want{beta,  beta + theta,    gamma,  phi + delta,
                                   delta, omega + epsilon, epsilon};
  for (uint32_t i = 0; i < 7; ++i) {
    CAPTURE(i);
    CHECK(std::fabs(std::remainder(w.angle(i) - want[i], 2 * std::numbers::pi)) < 1e-4);
  }
}

TEST_CASE("rows of four-bars pass the places where all rods lie flat") {
  {
    FourBars w(1000, 2);
    const double seconds = all_counts() ? 10 : only_to_run() ? 0.1 : 3, first = w.energy();
    w.run(seconds);
    CHECK(w.joint_error() < 1e-12);
    CHECK((w.top() - w.top_of_pendulum(seconds)).norm() < 1e-5);
    CHECK(std::fabs(w.energy() - first) < 1e-6);
    if (seconds == 10) CHECK((w.top() - Vec3(.328458, .944519, 0)).norm() < 2e-6);
  }
  {
    FourBars w(500, 40);
    const double seconds = all_counts() ? 10 : only_to_run() ? 0.02 : 0.6, first = w.energy();
    w.run(seconds);
    CHECK(w.joint_error() < 1e-12);
    CHECK((w.top() - w.top_of_pendulum(seconds)).norm() < 1e-4);
    CHECK(std::fabs(w.energy() - first) < 1e-4);
  }
}

TEST_CASE("Bricard's mechanism moves, and keeps its energy") {
  Bricard w(1000);
  const double first = w.energy();
  const Vec3 start = w.bodies[2].pose.x;
  double gone = 0, worst = 0;
  const int ticks = all_counts() ? 10000 : only_to_run() ? 50 : 2000;
  for (int i = 0; i < ticks; ++i) {
    w.step();
    gone = std::max(gone, (w.bodies[2].pose.x - start).norm());
    worst = std::max(worst, std::fabs(w.energy() - first));
  }
  CHECK(w.joint_error() < 1e-12);
  // Of the tens of joules that go to and fro.
  CHECK(worst < 2e-5);
  if (!only_to_run()) CHECK(gone > 0.5);
}

TEST_CASE(
    "the spatial slider-crank is where its energy has it, and the library of benchmarks nearly") {
  SpatialSliderCrank w(1000);
  const double first = w.energy();
  double angle = 0;
  const auto go = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      w.step();
      angle += std::remainder(w.crank_angle() - angle, 2 * std::numbers::pi);
    }
  };
  struct Figure {
    double t, x, angle;
  };
  for (const Figure& f : {Figure{.5, .1849586, 5.574337}, Figure{1, .2124956, 10.89762}}) {
    go(500);
    CAPTURE(f.t);
    CHECK(std::fabs(SpatialSliderCrank::time_to(angle) - f.t) < 1e-8);
    // The published figures are met this far only: with which moments of inertia they were computed
    // is not known here, and those of the crank and the rod decide the third digit.
    CHECK(std::fabs(w.bodies[2].pose.x.x() - f.x) < 1e-3);
    CHECK(std::fabs(angle - f.angle) < 2e-3 * f.angle);
  }
  CHECK(w.joint_error() < 1e-12);
  CHECK(std::fabs(w.energy() - first) < 1e-8);
}

TEST_CASE("a pendulum of twenty rods keeps its energy to a millionth of its range") {
  constexpr int n = 20;
  Mechanism w(4000);
  for (int i = 0; i < n; ++i) {
    const uint32_t made = w.rod({double(i), 0, 0}, {double(i + 1), 0, 0});
    w.hinge(i == 0 ? no_body : made - 1, made, {double(i), 0, 0});
  }
  const double range = g * n * n / 2;
  double worst = 0;
  const int ticks = all_counts() ? 60 * 4000 : only_to_run() ? 20 : 2000;
  for (int i = 0; i < ticks; ++i) {
    w.step();
    worst = std::max(worst, std::fabs(w.energy()) / range);
  }
  MESSAGE("energy error of the range: " << worst);
  CHECK(worst < 1e-6);
  CHECK(w.joint_error() < 1e-12);
}

TEST_CASE("joints do not drift apart, however many ticks there are") {
  Mechanism w(1000);
  w.hinge(no_body, w.rod({0, 0, 0}, {1, 0, 0}), {0, 0, 0});
  w.join(JointKind::universal, 0, w.rod({1, 0, 0}, {1.5, 0, 0}), {{1, 0, 0}, Quat::Identity()});
  w.bodies[1].omega = {0, 0.5, 0};
  w.bodies[1].v = w.bodies[1].omega.cross(Vec3(0.25, 0, 0));
  double worst = 0;
  for (int i = 0; i < graded_count(1000000, 2000, 20); ++i) {
    w.step();
    worst = std::max(worst, w.joint_error());
  }
  CHECK(worst < 1e-8);
}

TEST_CASE("a rimless wheel comes to the gait that its spokes' impacts allow") {
  // Between impacts it turns about a spoke's tip; at each the share (I + m l^2 cos 2a) / (I + m
  // l^2) of the rate is left, 2a being the angle between spokes.
  constexpr double slope = 0.15, inertia = 0.1, half = std::numbers::pi / 8;
  EventWorld w(240);
  w.gravity = g * Vec3(std::sin(slope), -std::cos(slope), 0);
  w.floor(1);
  TriangleMesh rim;
  for (int i = 0; i < 8; ++i)
    for (const double z : {-0.3, 0.3})
      rim.vertices.emplace_back(std::sin(half * (2 * i + 1)), std::cos(half * (2 * i + 1)), z);
  BodyDef wheel = body(hull(std::move(rim)), {0, std::cos(half), 0}, 1, 0);
  wheel.mass = 1;
  wheel.inertia = Vec3::Constant(inertia);
  // Upon its leading spoke.
  const double rate = 1.8;
  const Vec3 arm(-std::sin(half), std::cos(half), 0);
  wheel.angular_velocity = {0, 0, -rate};
  wheel.velocity = wheel.angular_velocity.cross(arm);
  const uint32_t slot = w.add(wheel);
  const double about_tip = inertia + 1, left = (inertia + std::cos(2 * half)) / about_tip;
  const double gained = 2 * g * std::sin(half) * std::sin(slope);
  w.run(only_to_run() ? 0.05 : 4);
  if (only_to_run()) return;
  const RigidBody& b = w.bodies[slot];
  Vec3 tip = Vec3::Zero();
  for (int i = 0; i < 8; ++i) {
    const Vec3 at = b.pose.q * Vec3(std::sin(half * (2 * i + 1)), std::cos(half * (2 * i + 1)), 0);
    if (at.y() < tip.y()) tip = at;
  }
  const double way = (b.pose.x + tip).x() - std::sin(half), width = 2 * std::sin(half);
  const int impacts = int(std::lround(way / width));
  CHECK(impacts >= 6);
  CHECK(way == doctest::Approx(impacts * width).epsilon(1e-8));
  double turning = 0.5 * about_tip * rate * rate;
  for (int i = 0; i < impacts; ++i) turning = left * left * (turning + gained);
  const double steady = left * left * gained / (1 - left * left);
  CHECK(std::fabs(turning - steady) < 0.05 * steady);
  // Energy about the tip that bears, by the height over it.
  const double energy = 0.5 * about_tip * b.omega.squaredNorm() + w.gravity.dot(tip);
  CHECK(energy == doctest::Approx(turning + g * std::cos(half - slope)).epsilon(1e-8));
}
