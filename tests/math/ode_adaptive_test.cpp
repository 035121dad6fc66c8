// Steps chosen by the error. References: Kepler's equation for an orbit of eccentricity 0.9; for
// single steps the classical method in extended precision with 256 sub-steps; the closed Arenstorf
// orbit with the initial values and period of Hairer, Norsett, Wanner, Solving ODEs I, II.0.
#include "tests/math/ode_problems.hpp"

#include <doctest/doctest.h>

using namespace tumble::ode;
using namespace tumble::ode::test;

namespace {

std::unique_ptr<Integrator> rk45(double tolerance) {
  auto integrator = all_integrators().back().make();
  integrator->settings.tolerance = {tolerance, tolerance, tolerance};
  return integrator;
}

using Long4 = std::array<long double, 4>;

Long4 kepler_rate(const Long4& y) {
  const long double r2 = y[0] * y[0] + y[1] * y[1], k = 1 / (r2 * std::sqrt(r2));
  return {y[2], y[3], -k * y[0], -k * y[1]};
}

Long4 plus(const Long4& y, long double h, const Long4& d) {
  return {y[0] + h * d[0], y[1] + h * d[1], y[2] + h * d[2], y[3] + h * d[3]};
}

/// The flow over one step, in 256 steps of the classical method.
Long4 flow(Long4 y, long double h) {
  h /= 256;
  for (int i = 0; i < 256; ++i) {
    const Long4 a = kepler_rate(y), b = kepler_rate(plus(y, h / 2, a)),
                c = kepler_rate(plus(y, h / 2, b)), d = kepler_rate(plus(y, h, c));
    for (size_t k = 0; k < 4; ++k) y[k] += h / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
  }
  return y;
}

/// Restricted three-body problem in the rotating frame of Earth and Moon.
class Arenstorf : public System {
 public:
  size_t size() const override { return 4; }
  bool derivative(double, std::span<const double> y, std::span<double> d) override {
    constexpr double mu = 0.012277471, nu = 1 - mu;
    const double a = (y[0] + mu) * (y[0] + mu) + y[1] * y[1], d1 = a * std::sqrt(a);
    const double b = (y[0] - nu) * (y[0] - nu) + y[1] * y[1], d2 = b * std::sqrt(b);
    d[0] = y[2];
    d[1] = y[3];
    d[2] = y[0] + 2 * y[3] - nu * (y[0] + mu) / d1 - mu * (y[0] - nu) / d2;
    d[3] = y[1] - 2 * y[2] - nu * y[1] / d1 - mu * y[1] / d2;
    return true;
  }
};

constexpr double arenstorf_period = 17.0652165601579625588917206249;

State arenstorf_start() {
  return {0.994, 0, 0, -2.00158510637908252240537862224};
}

}  // namespace

TEST_CASE("no step on a Kepler orbit of eccentricity 0.9 errs by more than asked") {
  for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
    CAPTURE(tolerance);
    Kepler problem(0.9);
    const auto integrator = rk45(tolerance);
    State y = problem.start();
    double t = 0, worst = 0, shortest = 1, longest = 0;
    const double end = 2 * 3.14159265358979323846;
    while (t < end) {
      const State before = y;
      const StepReport r = integrator->step(problem, t, end - t, y);
      REQUIRE(r.ok());
      CHECK(r.error <= 1);
      const Long4 exact = flow({before[0], before[1], before[2], before[3]}, r.advanced);
      for (size_t k = 0; k < 4; ++k) {
        const double allowed = tolerance * (1 + std::max(std::fabs(before[k]), std::fabs(y[k])));
        worst = std::max(worst, std::fabs(y[k] - double(exact[k])) / allowed);
      }
      shortest = std::min(shortest, r.advanced);
      longest = std::max(longest, r.advanced);
      t = r.advanced == end - t ? end : t + r.advanced;
    }
    CHECK(worst < 1);
    CHECK(longest > 10 * shortest);  // the orbit asks for it
    CHECK(difference(y, problem.exact(end)) < 1e4 * tolerance);
  }
}

TEST_CASE(
    "the error at the end of ten Kepler orbits goes with the asked error, and steps with its fifth "
    "root") {
  double error[2];
  uint32_t steps[2];
  for (int k = 0; k < 2; ++k) {
    Kepler problem(0.9);
    const auto integrator = rk45(k ? 1e-11 : 1e-8);
    State y = problem.start();
    const double end = 20 * 3.14159265358979323846;
    const StepReport r = integrator->advance(problem, 0, end, y);
    REQUIRE(r.ok());
    CHECK(r.advanced == end);
    CHECK(integrator->step_end() == end);
    error[k] = difference(y, problem.exact(end));
    steps[k] = r.steps;
  }
  CHECK(error[0] / error[1] > 100);
  CHECK(error[0] / error[1] < 10000);
  CHECK(double(steps[1]) / steps[0] == doctest::Approx(std::pow(1000, 0.2)).epsilon(0.15));
}

TEST_CASE("the Arenstorf orbit closes after its period") {
  double before = 1e300;
  for (const double tolerance : {1e-6, 1e-8, 1e-10, 1e-12}) {
    CAPTURE(tolerance);
    Arenstorf problem;
    const auto integrator = rk45(tolerance);
    State y = arenstorf_start();
    const StepReport r = integrator->advance(problem, 0, arenstorf_period, y);
    REQUIRE(r.ok());
    const State start = arenstorf_start();
    const double error = std::hypot(y[0] - start[0], y[1] - start[1]);
    CAPTURE(error);
    CHECK(error < before);
    // Passing the Moon twice magnifies errors by about 1e5.
    if (tolerance < 1e-7) CHECK(error < 1e6 * tolerance);
    before = error / 5;
    CHECK(r.steps < 4000);
  }
}

TEST_CASE(
    "a run continued from a saved step size has the bits of the run that was not interrupted") {
  Kepler problem(0.9);
  const auto whole = rk45(1e-9);
  State a = problem.start();
  State b = a;
  AdaptiveState saved;
  for (int tick = 0; tick < 100; ++tick) {
    const double t = tick / 20.0, h = (tick + 1) / 20.0 - t;
    REQUIRE(whole->advance(problem, t, h, a).ok());
    const auto fresh = rk45(1e-9);
    fresh->set_adaptive_state(saved);
    REQUIRE(fresh->advance(problem, t, h, b).ok());
    saved = fresh->adaptive_state();
    REQUIRE(saved == whole->adaptive_state());
    REQUIRE(a == b);
  }
  CHECK(saved.h > 0);
}

TEST_CASE("steps backwards are chosen too, and lead back") {
  Kepler problem(0.9);
  const auto integrator = rk45(1e-11);
  State y = problem.exact(3);
  const StepReport r = integrator->advance(problem, 3, -3, y);
  REQUIRE(r.ok());
  CHECK(r.advanced == -3);
  CHECK(r.steps > 20);
  CHECK(difference(y, problem.start()) < 1e-7);
}

TEST_CASE("a solution that leaves to infinity is followed to its end and refused there") {
  struct Square : System {
    size_t size() const override { return 1; }
    bool derivative(double, std::span<const double> y, std::span<double> d) override {
      d[0] = y[0] * y[0];
      return true;
    }
  } problem;  // y = 1 / (1 - t)
  const auto integrator = rk45(1e-9);
  State y{1};
  const AdaptiveState before = integrator->adaptive_state();
  double t = 0;
  StepReport r;
  while ((r = integrator->step(problem, t, 2 - t, y)).ok()) t += r.advanced;
  CHECK(t == doctest::Approx(1).epsilon(1e-6));
  CHECK((r.status == StepStatus::step_too_small || r.status == StepStatus::non_finite));
  CHECK(r.component == 0);
  y = {1};
  integrator->set_adaptive_state(before);
  const StepReport all = integrator->advance(problem, 0, 2, y);
  CHECK(!all.ok());
  CHECK(all.advanced == 0);
  CHECK(y[0] == 1);
}

TEST_CASE("a jump in the force is stepped across with the asked error") {
  struct Jump : System {
    size_t size() const override { return 2; }
    bool derivative(double t, std::span<const double> y, std::span<double> d) override {
      d[0] = y[1];
      d[1] = t < 1.0 / 3 ? 1 : -2;
      return true;
    }
  } problem;
  const auto integrator = rk45(1e-9);
  State y{0, 0};
  const StepReport r = integrator->advance(problem, 0, 1, y);
  REQUIRE(r.ok());
  CHECK(r.rejected > 0);
  CHECK(std::fabs(y[1] - (1.0 / 3 - 4.0 / 3)) < 1e-8);
  CHECK(std::fabs(y[0] - (1.0 / 18 + 2.0 / 9 - 4.0 / 9)) < 1e-8);
}

TEST_CASE("limits on the number of steps and on their length are kept") {
  Kepler problem(0.9);
  const auto few = rk45(1e-12);
  few->settings.max_steps = 10;
  State y = problem.start();
  StepReport r = few->advance(problem, 0, 6, y);
  CHECK(r.status == StepStatus::too_many_steps);
  CHECK(r.steps == 10);
  CHECK(y == problem.start());
  const auto coarse = rk45(1e-12);
  coarse->settings.min_step = 0.1;
  coarse->set_adaptive_state({0.5, 1e-4});
  r = coarse->advance(problem, 0, 6, y);
  CHECK(r.status == StepStatus::step_too_small);
  CHECK(y == problem.start());
  CHECK(coarse->adaptive_state() == AdaptiveState{0.5, 1e-4});
}
