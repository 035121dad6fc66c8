// Implicit Euler. References: closed forms of stiff linear equations; Robertson's chemical reaction
// with its published values at t = 40 (Hairer, Wanner, Solving ODEs II, IV.1); equations whose
// implicit step has a closed form or no solution.
#include "tests/math/ode_problems.hpp"

#include <functional>

#include <doctest/doctest.h>

using namespace tumble::ode;
using namespace tumble::ode::test;

namespace {

std::unique_ptr<Integrator> implicit_euler() {
  for (const IntegratorEntry& e : all_integrators()) {
    if (e.name == "implicit_euler") return e.make();
  }
  return nullptr;
}

/// One equation y' = f(t, y), with its df/dy where given.
struct Scalar : System {
  std::function<double(double, double)> f, df;
  size_t size() const override { return 1; }
  bool derivative(double t, std::span<const double> y, std::span<double> d) override {
    d[0] = f(t, y[0]);
    return true;
  }
  bool jacobian(double t, std::span<const double> y, std::span<double> rows) override {
    if (!df) return false;
    rows[0] = df(t, y[0]);
    return true;
  }
};

struct Robertson : System {
  bool analytic = false;
  size_t size() const override { return 3; }
  bool derivative(double, std::span<const double> y, std::span<double> d) override {
    const double a = 0.04 * y[0], b = 1e4 * y[1] * y[2], c = 3e7 * y[1] * y[1];
    d[0] = b - a;
    d[1] = a - b - c;
    d[2] = c;
    return true;
  }
  bool jacobian(double, std::span<const double> y, std::span<double> rows) override {
    if (!analytic) return false;
    const double J[9] = {-0.04,       1e4 * y[2], 1e4 * y[1], 0.04, -1e4 * y[2] - 6e7 * y[1],
                         -1e4 * y[1], 0,          6e7 * y[1], 0};
    std::copy(J, J + 9, rows.begin());
    return true;
  }
};

}  // namespace

TEST_CASE("implicit Euler is L-stable: a step on y' = -k y divides by 1 + k h, however large") {
  for (const double k : {1.0, 1e3, 1e9, 1e15}) {
    Scalar s;
    s.f = [k](double, double y) { return -k * y; };
    for (const bool analytic : {false, true}) {
      if (analytic) s.df = [k](double, double) { return -k; };
      const auto integrator = implicit_euler();
      State y{1};
      const StepReport r = integrator->step(s, 0, 0.1, y);
      REQUIRE(r.ok());
      CHECK(r.newton_iterations <= 3);
      CHECK(std::fabs(y[0] - 1 / (1 + 0.1 * k)) < 1e-12);
    }
  }
}

TEST_CASE("a stiff equation is followed at first order with steps far beyond explicit stability") {
  // y' = -1e6 (y - cos t) - sin t, solution cos t.
  Scalar s;
  s.f = [](double t, double y) { return -1e6 * (y - std::cos(t)) - std::sin(t); };
  double error[2];
  for (int k = 0; k < 2; ++k) {
    const auto integrator = implicit_euler();
    const int n = 20 << k;
    State y{1};
    for (int i = 0; i < n; ++i) REQUIRE(integrator->step(s, 2.0 * i / n, 2.0 / n, y).ok());
    error[k] = std::fabs(y[0] - std::cos(2.0));
  }
  CHECK(error[0] < 1e-6);
  CHECK(std::log2(error[0] / error[1]) == doctest::Approx(1).epsilon(0.1));
}

TEST_CASE("Robertson's reaction reaches its published state, by either Jacobian") {
  for (const bool analytic : {false, true}) {
    Robertson problem;
    problem.analytic = analytic;
    State result[2];
    for (int k = 0; k < 2; ++k) {
      const auto integrator = implicit_euler();
      integrator->settings.newton = {1e-15, 1e-15, 1e-11};
      const int n = 2000 << k;
      State y{1, 0, 0};
      for (int i = 0; i < n; ++i)
        REQUIRE(integrator->step(problem, 40.0 * i / n, 40.0 / n, y).ok());
      result[k] = y;
    }
    const State published{0.7158270688, 9.185534764e-6, 0.2841637457};
    for (size_t i = 0; i < 3; ++i) {
      const double extrapolated = 2 * result[1][i] - result[0][i];
      CHECK(result[1][i] == doctest::Approx(published[i]).epsilon(1e-3));
      CHECK(extrapolated == doctest::Approx(published[i]).epsilon(1e-5));
    }
    CHECK(result[1][0] + result[1][1] + result[1][2] == doctest::Approx(1).epsilon(1e-10));
  }
}

TEST_CASE("Newton is damped where its full step leads away") {
  // z = 3 - 5 atan(z): a full step from 3 diverges.
  Scalar s;
  s.f = [](double, double y) { return -500 * std::atan(y - 10); };
  s.df = [](double, double y) { return -500 / (1 + (y - 10) * (y - 10)); };
  const auto integrator = implicit_euler();
  for (const double start : {13.0, 30.0, -200.0}) {
    State y{start};
    const StepReport r = integrator->step(s, 0, 1, y);
    REQUIRE(r.ok());
    CHECK(std::fabs(y[0] - start + 500 * std::atan(y[0] - 10)) < 1e-7);  // slope 500 at the root
    CHECK(r.newton_iterations > 3);
  }
}

TEST_CASE("an implicit step without a solution is refused and leaves the state alone") {
  Scalar s;
  s.f = [](double, double y) { return 1 + y * y; };  // z = 1 + h (1 + z^2) has no root for h = 1
  const auto integrator = implicit_euler();
  State y{1};
  const StepReport r = integrator->step(s, 0, 1, y);
  CHECK(r.status == StepStatus::not_converged);
  CHECK(r.component == 0);
  CHECK(y[0] == 1);
  CHECK(r.text("implicit_euler", s).text().find("was not solved") != std::string::npos);
  // A singular matrix: y' = y with h = 1.
  s.f = [](double, double v) { return v; };
  s.df = [](double, double) { return 1.0; };
  CHECK(integrator->step(s, 0, 1, y).status == StepStatus::not_converged);
  CHECK(y[0] == 1);
  // A smaller step goes.
  REQUIRE(integrator->step(s, 0, 0.5, y).ok());
  CHECK(y[0] == doctest::Approx(2));
}

TEST_CASE("quadratures stay out of Newton's equations and are booked at the end of the step") {
  Oscillator problem;
  const auto integrator = implicit_euler();
  State y = problem.start();
  const StepReport r = integrator->step(problem, 0, 0.1, y);
  REQUIRE(r.ok());
  // One for the start, two for differences, one per iteration.
  CHECK(r.evaluations == 3 + r.newton_iterations);
  CHECK(y[2] == doctest::Approx(-0.1 * y[0] * y[1]).epsilon(1e-13));
}
