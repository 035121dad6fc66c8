// Rigid bodies under the integrators of math/ode. References: constants of free motion; for the
// intermediate axis the half period 2 K(k) / rate of Jacobi's sn (Landau, Lifshitz, Mechanics, 37)
// and the flips of Euler's equations at 1e-4 s (case A6 of the peers' workloads); for bodies on a
// spring the energy balance, and rk45 at a tolerance far below the errors measured.
#include "engine/dynamics/bodies/free_motion.hpp"

#include "engine/core/hash.hpp"
#include "engine/core/registry.hpp"
#include "engine/math/ode/integrator.hpp"
#include "engine/math/rotation.hpp"

#include <cmath>
#include <vector>

#include <boost/math/special_functions/ellint_1.hpp>
#include <doctest/doctest.h>

using namespace tumble;

namespace {

using OdeState = std::vector<double>;

const Vec3 handle_moments(0.5, 1, 1.3), handle_omega(0.01, 5, 0.01);

std::unique_ptr<ode::Integrator> integrator_named(std::string_view name) {
  return (*find_named(ode::all_integrators(), name, "integrator"))->make();
}

FreeMotion t_handle() {
  MotionConstants c;
  c.inertia_body = handle_moments.asDiagonal();
  return *FreeMotion::make({c});
}

OdeState handle_start(const FreeMotion& m) {
  OdeState y(m.size());
  m.write(0, Pose{}, Vec3::Zero(), handle_omega, y);
  return y;
}

double omega_y(const FreeMotion& m, std::span<const double> y) {
  const MotionState s = m.read(0, y);
  return s.pose.inverse_direction(s.omega).y();
}

/// Flips of Euler's equations about principal axes by RK4 at 1e-4 s, as the peers' case counts.
int reference_flips(double seconds) {
  const auto rate = [](const Vec3& w) {
    const Vec3& I = handle_moments;
    return Vec3((I.y() - I.z()) * w.y() * w.z() / I.x(), (I.z() - I.x()) * w.z() * w.x() / I.y(),
                (I.x() - I.y()) * w.x() * w.y() / I.z());
  };
  Vec3 w = handle_omega;
  const double h = 1e-4;
  double side = 1;
  int flips = 0;
  for (int k = 0; k < int(std::lround(seconds / h)); ++k) {
    const Vec3 a = rate(w), b = rate(w + h / 2 * a), c = rate(w + h / 2 * b), d = rate(w + h * c);
    w += h / 6 * (a + 2 * b + 2 * c + d);
    if (std::abs(w.y()) > 1 && w.y() * side < 0) {
      ++flips;
      side = -side;
    }
  }
  return flips;
}

/// Where in the last step omega_y, which began as `before`, is zero: by bisection of dense output.
double crossing(const ode::Integrator& integrator, const FreeMotion& m, double before,
                OdeState& between) {
  double lo = integrator.step_begin(), hi = integrator.step_end();
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (lo + hi);
    integrator.at(m, middle, between);
    (omega_y(m, between) * before > 0 ? lo : hi) = middle;
  }
  return 0.5 * (lo + hi);
}

struct HandleRun {
  double momentum = 0, energy = 0;  ///< greatest relative change
  int flips = 0;
  std::vector<double> crossings;  ///< times at which omega_y is zero [s]
};

HandleRun run_handle(ode::Integrator& integrator, double hz, double seconds) {
  FreeMotion m = t_handle();
  OdeState y = handle_start(m), between(m.size());
  const MotionState start = m.read(0, y);
  HandleRun out;
  double side = 1;
  for (int k = 0; k < int(std::lround(seconds * hz)); ++k) {
    const double before = omega_y(m, y);
    REQUIRE(integrator.advance(m, k / hz, 1 / hz, y).ok());
    const MotionState s = m.read(0, y);
    out.momentum = std::max(out.momentum, (s.angular_momentum - start.angular_momentum).norm() /
                                              start.angular_momentum.norm());
    out.energy = std::max(out.energy, std::fabs(s.kinetic_energy() / start.kinetic_energy() - 1));
    const double now = omega_y(m, y);
    if (std::abs(now) > 1 && now * side < 0) {
      ++out.flips;
      side = -side;
    }
    if (before * now < 0 && !integrator.adaptive()) {
      out.crossings.push_back(crossing(integrator, m, before, between));
    }
  }
  return out;
}

/// Two bodies joined by a spring between points away from their centres, with the spring's work on
/// them as a quadrature.
struct SpringPair {
  double stiffness = 6, rest = 0.5;
  Vec3 arm_a{0.2, 0.1, 0}, arm_b{-0.1, 0, 0.3};

  double potential(const MotionState& a, const MotionState& b) const {
    const double stretch = (b.pose.point(arm_b) - a.pose.point(arm_a)).norm() - rest;
    return 0.5 * stiffness * stretch * stretch;
  }
  bool operator()(MotionForces& f) const {
    const MotionState &a = f.bodies[0], &b = f.bodies[1];
    const Vec3 p = a.pose.point(arm_a), q = b.pose.point(arm_b), across = q - p;
    const double length = across.norm();
    const Vec3 pull = stiffness * (length - rest) / length * across;
    f.wrenches[0].add(a, pull, p);
    f.wrenches[1].add(b, -pull, q);
    f.quadrature_rates[0] = pull.dot(a.velocity_at(p)) - pull.dot(b.velocity_at(q));
    return true;
  }
  FreeMotion motion() const {
    MotionConstants a, b;
    a.inertia_body = Vec3(0.1, 0.2, 0.25).asDiagonal();
    b.mass = 3;
    const Mat3 R = axis_angle({1, 2, 3}, 1).toRotationMatrix();
    b.inertia_body = R * Vec3(0.3, 0.5, 0.6).asDiagonal() * R.transpose();
    b.inertia_body = (0.5 * (b.inertia_body + b.inertia_body.transpose()));
    return *FreeMotion::make({a, b}, *this, 1);
  }
  OdeState start(const FreeMotion& m) const {
    OdeState y(m.size());
    m.write(0, {Vec3(0, 0, 0), axis_angle({0, 1, 1}, 0.4)}, {0.3, 0, -0.2}, {1, 2, -0.5}, y);
    m.write(1, {Vec3(1, 0.4, -0.2), axis_angle({1, 0, 1}, 2)}, {0, 0.5, 0}, {-1, 0.3, 0.8}, y);
    return y;
  }
};

double kinetic(const FreeMotion& m, std::span<const double> y) {
  return m.read(0, y).kinetic_energy() + m.read(1, y).kinetic_energy();
}

OdeState run_pair(std::string_view name, const SpringPair& pair, int steps, double time) {
  FreeMotion m = pair.motion();
  OdeState y = pair.start(m);
  const auto integrator = integrator_named(name);
  if (integrator->adaptive()) {
    integrator->settings.tolerance = {1e20, 1e20, 1e20};
    integrator->set_adaptive_state({2 * time / steps, 1});
  }
  for (int i = 0; i < steps; ++i) {
    REQUIRE(integrator->step(m, i * time / steps, time / steps, y).ok());
  }
  return y;
}

}  // namespace

TEST_CASE("a spinning T-handle by RK4 keeps L and E and flips as often as it should (A6)") {
  const auto rk4 = integrator_named("rk4");
  const int flips = reference_flips(60);
  CHECK(flips > 5);
  const HandleRun coarse = run_handle(*rk4, 60, 60), fine = run_handle(*rk4, 240, 60);
  MESSAGE("energy at 1/60 ", coarse.energy, ", at 1/240 ", fine.energy);
  for (const HandleRun* r : {&coarse, &fine}) {
    CHECK(r->momentum < 1e-12);
    CHECK(r->flips == flips);
  }
  CHECK(coarse.energy < 1e-6);
  CHECK(fine.energy < 1e-8);
}

TEST_CASE("the flips of a T-handle have the closed-form period") {
  const Vec3& I = handle_moments;
  const Vec3 w = handle_omega;
  const double E2 = (I.array() * w.array().square()).sum();
  const double M2 = (I.array() * w.array()).square().sum();
  // sn has the intermediate axis; which of the outer axes has dn depends on which side L is.
  double a = E2 * I.z() - M2, b = M2 - E2 * I.x();
  double rate = std::sqrt((I.z() - I.y()) * b / (I.x() * I.y() * I.z()));
  double k2 = (I.y() - I.x()) * a / ((I.z() - I.y()) * b);
  if (k2 > 1) {
    rate = std::sqrt((I.y() - I.x()) * a / (I.x() * I.y() * I.z()));
    k2 = 1 / k2;
  }
  const double half_period = 2 * boost::math::ellint_1(std::sqrt(k2)) / rate;
  double worst[2];
  for (int k = 0; k < 2; ++k) {
    const auto rk4 = integrator_named("rk4");
    const HandleRun r = run_handle(*rk4, k ? 240 : 120, 40);
    REQUIRE(r.crossings.size() > 4);
    worst[k] = 0;
    for (size_t i = 1; i < r.crossings.size(); ++i) {
      worst[k] = std::max(worst[k], std::fabs(r.crossings[i] - r.crossings[i - 1] - half_period));
    }
  }
  CHECK(worst[1] < 1e-4 * half_period);
  CHECK(worst[0] / worst[1] > 8);

  // With chosen steps to nearly all digits.
  FreeMotion m = t_handle();
  OdeState y = handle_start(m), between(m.size());
  const auto rk45 = integrator_named("rk45");
  rk45->settings.tolerance = {1e-13, 1e-13, 1e-13};
  double t = 0, last = 0;
  int crossings = 0;
  while (t < 30) {
    const double before = omega_y(m, y);
    const ode::StepReport r = rk45->step(m, t, 30 - t, y);
    REQUIRE(r.ok());
    t = rk45->step_end();
    if (before * omega_y(m, y) > 0) continue;
    const double now = crossing(*rk45, m, before, between);
    if (crossings++ > 0) CHECK(std::fabs(now - last - half_period) < 5e-8 * half_period);
    last = now;
  }
  CHECK(crossings > 3);
}

TEST_CASE("every integrator keeps L of free tumbling exactly, and energy to its order or better") {
  for (const auto& entry : ode::all_integrators()) {
    CAPTURE(entry.name);
    double energy[2];
    for (int k = 0; k < 2; ++k) {
      const auto integrator = entry.make();
      if (integrator->adaptive()) integrator->settings.tolerance = {1e20, 1e20, 1e20};
      const HandleRun r = run_handle(*integrator, entry.order == 1 ? 1000 << k : 30 << k, 6);
      CHECK(r.momentum == 0);
      energy[k] = r.energy;
    }
    CHECK(energy[0] > 1e-12);
    CHECK(std::log2(energy[0] / energy[1]) > entry.order - 0.3);
  }
}

TEST_CASE("steps chosen by position and orientation keep the asked error on the T-handle") {
  for (const double tolerance : {1e-6, 1e-9}) {
    FreeMotion m = t_handle();
    const auto rk45 = integrator_named("rk45"), reference = integrator_named("rk45");
    rk45->settings.tolerance = {tolerance, tolerance, tolerance};
    reference->settings.tolerance = {1e-13, 1e-13, 1e-13};
    OdeState y = handle_start(m);
    double t = 0, worst = 0;
    while (t < 10) {
      OdeState exact = y;
      const ode::StepReport r = rk45->step(m, t, 10 - t, y);
      REQUIRE(r.ok());
      REQUIRE(reference->advance(m, t, r.advanced, exact).ok());
      const Quat found = m.read(0, y).pose.q, right = m.read(0, exact).pose.q;
      worst = std::max(worst, 2 * (found * right.conjugate()).vec().norm());
      t += r.advanced;
    }
    CHECK(worst < tolerance);
    CHECK(worst > 1e-4 * tolerance);
  }
}

TEST_CASE(
    "two bodies on a spring: every integrator's order, exact momentum, and the work is booked") {
  const SpringPair pair;
  FreeMotion m = pair.motion();
  const double time = 1;
  const OdeState start = pair.start(m);
  OdeState exact = start;
  const auto reference = integrator_named("rk45");
  reference->settings.tolerance = {1e-13, 1e-13, 1e-13};
  REQUIRE(reference->advance(m, 0, time, exact).ok());
  const double before = kinetic(m, start) + pair.potential(m.read(0, start), m.read(1, start));
  CHECK(std::fabs(kinetic(m, exact) + pair.potential(m.read(0, exact), m.read(1, exact)) - before) <
        1e-10);
  CHECK(std::fabs(kinetic(m, exact) - kinetic(m, start) - exact.back()) < 1e-10);

  for (const auto& entry : ode::all_integrators()) {
    CAPTURE(entry.name);
    double error[2], book[2];
    for (int k = 0; k < 2; ++k) {
      const int steps = (entry.order == 1   ? 1000
                         : entry.order == 2 ? 200
                         : entry.order == 4 ? 60
                                            : 40)
                        << k;
      const OdeState y = run_pair(entry.name, pair, steps, time);
      error[k] = 0;
      for (size_t i = 0; i < y.size(); ++i)
        error[k] = std::max(error[k], std::fabs(y[i] - exact[i]));
      // What the books leave over is the integrator's error.
      book[k] = std::fabs(kinetic(m, y) - kinetic(m, start) - y.back());
      const Vec3 P0 = m.read(0, start).momentum + m.read(1, start).momentum;
      CHECK((m.read(0, y).momentum + m.read(1, y).momentum - P0).norm() < 1e-12);
    }
    CAPTURE(error[0]);
    CAPTURE(error[1]);
    CHECK(std::log2(error[0] / error[1]) == doctest::Approx(entry.order).epsilon(0.08));
    CHECK(std::log2(book[0] / book[1]) > entry.order - 0.3);
  }
}

TEST_CASE("constants that cannot move are refused by name, and faults name body and entry") {
  MotionConstants c;
  c.name = "brick";
  c.mass = 0;
  Result<FreeMotion> m = FreeMotion::make({c});
  REQUIRE(!m);
  CHECK(m.error().text().find("brick: mass must be > 0") != std::string::npos);
  c.mass = 1;
  c.inertia_body = Vec3(1, -1, 1).asDiagonal();
  CHECK(!FreeMotion::make({c}));
  c.inertia_body = Mat3::Identity();
  c.inertia_body(0, 1) = 0.1;
  CHECK(!FreeMotion::make({c}));
  c.inertia_body(0, 1) = NAN;
  CHECK(!FreeMotion::make({c}));
  c.inertia_body = Mat3::Identity();

  FreeMotion bad = *FreeMotion::make({MotionConstants{}, c}, [](MotionForces& f) {
    f.wrenches[1].torque.y() = NAN;
    return true;
  });
  OdeState y(bad.size(), 0.0);
  for (size_t i = 0; i < 2; ++i) bad.write(i, Pose{}, Vec3::Zero(), Vec3::Zero(), y);
  const OdeState before = y;
  const auto rk4 = integrator_named("rk4");
  const ode::StepReport r = rk4->step(bad, 0, 0.1, y);
  CHECK(r.status == ode::StepStatus::non_finite);
  CHECK(r.text("rk4", bad).text().find("L.y of brick") != std::string::npos);
  CHECK(y == before);
}

TEST_CASE("states are written and read without loss") {
  const SpringPair pair;
  const FreeMotion m = pair.motion();
  OdeState y(m.size());
  const Pose pose{Vec3(1, -2, 3), axis_angle({3, 1, 2}, 2.5)};
  const Vec3 v(4, 5, -6), w(0.7, -0.8, 0.9);
  m.write(1, pose, v, w, y);
  const MotionState s = m.read(1, y);
  CHECK((s.pose.x - pose.x).norm() == 0);
  CHECK((s.pose.q.coeffs() - pose.q.coeffs()).norm() < 1e-15);
  CHECK((s.v - v).norm() < 1e-14);
  CHECK((s.omega - w).norm() < 1e-14);
  CHECK((s.velocity_at(Vec3(2, -2, 3)) - v - w.cross(Vec3::UnitX())).norm() < 1e-14);
}

TEST_CASE("every compiler moves bodies on a spring to the same bits") {
  uint64_t hash = 0;
  for (const auto& entry : ode::all_integrators()) {
    const OdeState y = run_pair(entry.name, SpringPair{}, 50, 1);
    hash = hash_bytes(y.data(), y.size() * sizeof(double), hash);
  }
  CHECK(hash_text(hash) == "e7227c93c35737dc");
}
