// Orders of convergence. References: closed forms of the oscillator (with the work of its spring as
// a quadrature), of the Kepler orbit (Kepler's equation in extended precision) and of the free top
// (Jacobi's elliptic functions; unit quaternion). Resolution: orders to 0.15.
#include "tests/math/ode_problems.hpp"
#include "tests/support/scale.hpp"

#include <doctest/doctest.h>

using namespace tumble::ode;
using namespace tumble::ode::test;

namespace {

/// Steps that put the errors well between rounding and the first signs of convergence.
int coarse_steps(int order) {
  return order == 1 ? 2000 : order == 2 ? 400 : order == 4 ? 100 : 60;
}

/// How often a step is halved for an order: under sanitizers, where the code is only to run, once.
int halvings() {
  return tumble::test::only_to_run() ? 1 : 2;
}

/// Observed order from n, 2n and 4n steps: near from the first pair, within 0.15 from the second.
void check_order(const IntegratorEntry& entry, Problem& problem, double time, bool quaternion) {
  CAPTURE(entry.name);
  double error[3] = {};
  const int last = halvings();
  for (int k = 0; k <= last; ++k) {
    const int n = coarse_steps(entry.order) << k;
    const auto integrator = entry.make();
    const State y = run(*integrator, problem, problem.start(), 0, time / n, n);
    REQUIRE(y.size() == problem.size());
    error[k] = difference(y, problem.exact(time), quaternion);
  }
  CAPTURE(error[0]);
  CAPTURE(error[last]);
  CHECK(error[last] > 1e-12);
  for (int k = 0; k < last; ++k) {
    CHECK(std::fabs(std::log2(error[k] / error[k + 1]) - entry.order) < (k ? 0.15 : 0.4));
  }
}

}  // namespace

TEST_CASE("the list of integrators has the names and orders of the house") {
  std::vector<std::string> names;
  for (const IntegratorEntry& e : all_integrators()) {
    names.emplace_back(e.name);
    const auto integrator = e.make();
    CHECK(integrator->name() == e.name);
    CHECK(integrator->order() == e.order);
    CHECK(!e.text.empty());
  }
  CHECK(names == std::vector<std::string>{"explicit_euler", "semi_implicit_euler", "implicit_euler",
                                          "rk2", "rk4", "rk45"});
}

TEST_CASE("every integrator has its order on the oscillator, and so has the work of its force") {
  for (const IntegratorEntry& e : all_integrators()) {
    Oscillator problem;
    check_order(e, problem, 12, false);
    // The work alone.
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const int n = coarse_steps(e.order) << k;
      const auto integrator = e.make();
      error[k] = std::fabs(run(*integrator, problem, problem.start(), 0, 12.0 / n, n)[2] -
                           problem.exact(12)[2]);
    }
    CAPTURE(e.name);
    CHECK(std::log2(error[0] / error[1]) > e.order - 0.15);
  }
}

TEST_CASE("every integrator has its order on a Kepler orbit") {
  for (const IntegratorEntry& e : all_integrators()) {
    Kepler problem(0.4);
    check_order(e, problem, 4, false);
  }
}

TEST_CASE("every integrator turns unit quaternions at its order: the free top") {
  for (const IntegratorEntry& e : all_integrators()) {
    FreeTop problem;
    check_order(e, problem, 6, true);
  }
}

TEST_CASE("a step backwards undoes a step to the integrator's order") {
  for (const IntegratorEntry& e : all_integrators()) {
    CAPTURE(e.name);
    Kepler problem(0.2);
    double error[2];
    for (int k = 0; k < 2; ++k) {
      const int n = coarse_steps(e.order) << k;
      const auto integrator = e.make();
      const State there = run(*integrator, problem, problem.start(), 0, 2.5 / n, n);
      const State back = run(*integrator, problem, there, 2.5, -2.5 / n, n);
      error[k] = difference(back, problem.start());
    }
    CHECK(error[0] < 0.05);
    // Errors of the two ways may cancel to a higher order, never to a lower one.
    CHECK(std::log2(error[0] / error[1]) > e.order - 0.5);
  }
}

namespace {

/// Errors of dense output over `time` in n, 2n and 4n steps; both ends are checked bit by bit.
void check_dense(const IntegratorEntry& entry, Problem& problem, double time, int n,
                 bool quaternion) {
  CAPTURE(entry.name);
  double error[3] = {};
  const int last = halvings();
  for (int k = 0; k <= last; ++k, n *= 2) {
    const double h = time / n;
    const auto integrator = entry.make();
    State y = problem.start(), between(y.size());
    for (int i = 0; i < n; ++i) {
      const State before = y;
      y = run(*integrator, problem, y, i * h, h, 1);
      integrator->at(problem, integrator->step_begin(), between);
      REQUIRE(between == before);
      integrator->at(problem, integrator->step_end(), between);
      REQUIRE(between == y);
      for (const double theta : {0.3, 0.8}) {
        integrator->at(problem, (i + theta) * h, between);
        error[k] =
            std::max(error[k], difference(between, problem.exact((i + theta) * h), quaternion));
        double square = 0;
        for (int c = 0; c < 4; ++c) square += between[size_t(c)] * between[size_t(c)];
        if (quaternion) REQUIRE(std::fabs(square - 1) < 1e-14);
      }
    }
  }
  CAPTURE(error[0]);
  CAPTURE(error[last]);
  CHECK(std::log2(error[0] / error[1]) > entry.order - 0.4);
  if (last == 2) CHECK(std::log2(error[1] / error[2]) > entry.order - 0.2);
}

}  // namespace

TEST_CASE(
    "dense output meets both ends bit by bit, and its error vanishes at the integrator's order") {
  for (const IntegratorEntry& e : all_integrators()) {
    Kepler orbit(0.3);
    check_dense(e, orbit, 2, e.order == 1 ? 400 : e.order == 2 ? 50 : 20, false);
    FreeTop top;
    check_dense(e, top, 0.5, e.order == 1 ? 20 : e.order == 2 ? 10 : 4, true);
  }
}
