// The discrete schemes themselves. References: stability functions and invariants in closed form;
// Butcher's order conditions for the tableaus and their dense output; LU against products.
#include "engine/core/random.hpp"
#include "engine/math/lu.hpp"
#include "engine/math/ode/tableau.hpp"
#include "tests/math/ode_problems.hpp"

#include <complex>
#include <functional>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::ode;
using namespace tumble::ode::test;

namespace {

/// A rooted tree by its children; the conditions of order p are those of the trees of p nodes.
struct Tree {
  std::vector<Tree> children;
  int nodes() const {
    int n = 1;
    for (const Tree& c : children) n += c.nodes();
    return n;
  }
  double gamma() const {
    double g = nodes();
    for (const Tree& c : children) g *= c.gamma();
    return g;
  }
  /// Product over the children of sum_j a_ij (child's weight at j).
  double weight(const Tableau& t, size_t i) const {
    double product = 1;
    for (const Tree& c : children) {
      double sum = 0;
      for (size_t j = 0; j < i; ++j) sum += t.a[i][j] * c.weight(t, j);
      product *= sum;
    }
    return product;
  }
};

/// All trees of n nodes: children of non-increasing index in the list of smaller trees.
std::vector<Tree> trees(int n) {
  std::vector<Tree> smaller;
  for (int k = 1; k < n; ++k) {
    for (Tree& t : trees(k)) smaller.push_back(std::move(t));
  }
  std::vector<Tree> out;
  std::vector<Tree> chosen;
  const std::function<void(size_t, int)> choose = [&](size_t last, int left) {
    if (left == 0) {
      out.push_back({chosen});
      return;
    }
    for (size_t i = 0; i < last; ++i) {
      if (smaller[i].nodes() > left) continue;
      chosen.push_back(smaller[i]);
      choose(i + 1, left - chosen.back().nodes());
      chosen.pop_back();
    }
  };
  choose(smaller.size(), n - 1);
  return out;
}

std::unique_ptr<Integrator> named(std::string_view name) {
  for (const IntegratorEntry& e : all_integrators()) {
    if (e.name == name) return e.make();
  }
  return nullptr;
}

/// The factor of one step on z' = i z as the integrator makes it.
std::complex<double> factor(std::string_view name, double h) {
  Oscillator problem;
  const auto integrator = named(name);
  const State y = run(*integrator, problem, {1, 0, 0}, 0, h, 1);
  return {y[0], -y[1]};  // x = Re z, v = -Im z
}

}  // namespace

TEST_CASE("tableaus and their dense outputs meet the conditions of their orders") {
  CHECK(trees(4).size() == 4);
  CHECK(trees(5).size() == 9);
  const struct {
    const Tableau& tableau;
    int dense_order;
  } cases[] = {{euler_tableau(), 1},
               {midpoint_tableau(), 2},
               {classical_tableau(), 3},
               {dormand_prince_tableau(), 4}};
  for (const auto& c : cases) {
    const Tableau& t = c.tableau;
    for (size_t i = 0; i < t.stages; ++i) {
      double sum = 0;
      for (size_t j = 0; j < i; ++j) sum += t.a[i][j];
      CHECK(std::fabs(sum - t.c[i]) < 4e-15);
      double end = 0;
      for (const double d : t.dense[i]) end += d;
      CHECK(std::fabs(end - t.b[i]) < 4e-14);
    }
    for (int n = 1; n <= t.order; ++n) {
      for (const Tree& tree : trees(n)) {
        double sum = 0, error = 0, dense = 0;
        const double theta = 0.37;
        for (size_t i = 0; i < t.stages; ++i) {
          const double w = tree.weight(t, i);
          sum += t.b[i] * w;
          error += t.error[i] * w;
          for (size_t m = 0; m < 4; ++m) dense += t.dense[i][m] * std::pow(theta, m + 1) * w;
        }
        CHECK(std::fabs(sum - 1 / tree.gamma()) < 1e-14);
        // The embedded method is of one order less, and no more.
        if (n < t.order) CHECK(std::fabs(error) < 1e-15);
        if (n <= c.dense_order) {
          CHECK(std::fabs(dense - std::pow(theta, n) / tree.gamma()) < 1e-14);
        }
      }
    }
  }
}

TEST_CASE("one step on the oscillator is the stability function of the method") {
  for (const double h : {0.01, 0.3, 1.0, -0.4}) {
    CAPTURE(h);
    const std::complex<double> z(0, h);
    CHECK(std::abs(factor("explicit_euler", h) - (1.0 + z)) < 1e-15);
    CHECK(std::abs(factor("implicit_euler", h) - 1.0 / (1.0 - z)) < 1e-14);
    CHECK(std::abs(factor("rk2", h) - (1.0 + z + z * z / 2.0)) < 1e-15);
    const std::complex<double> taylor =
        1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0;
    CHECK(std::abs(factor("rk4", h) - taylor) < 1e-15);
    const std::complex<double> z5 = z * z * z * z * z;
    CHECK(std::abs(factor("rk45", h) - (taylor + z5 / 120.0 + z5 * z / 600.0)) < 1e-14);
  }
}

TEST_CASE(
    "explicit Euler's amplitude grows by sqrt(1 + h^2) a step, implicit Euler's shrinks by it") {
  const double h = 0.05;
  const int n = 200;
  for (const int sign : {1, -1}) {
    Oscillator problem;
    const auto integrator = named(sign > 0 ? "explicit_euler" : "implicit_euler");
    const State y = run(*integrator, problem, {1, 0, 0}, 0, h, n);
    CHECK(std::hypot(y[0], y[1]) ==
          doctest::Approx(std::pow(1 + h * h, 0.5 * sign * n)).epsilon(1e-12));
  }
}

TEST_CASE("semi-implicit Euler keeps the oscillator's x^2 + v^2 - h x v, and books work exactly") {
  const double h = 0.3;
  Oscillator problem;
  const auto integrator = named("semi_implicit_euler");
  State y{1, 0.2, 0};
  const auto invariant = [&] { return y[0] * y[0] + y[1] * y[1] - h * y[0] * y[1]; };
  const double before = invariant(), kinetic = 0.5 * y[1] * y[1];
  State by_hand = y;
  for (int i = 0; i < 10000; ++i) {
    y = run(*integrator, problem, y, i * h, h, 1);
    by_hand[1] -= h * by_hand[0];
    by_hand[0] += h * by_hand[1];
    REQUIRE(y[0] == by_hand[0]);
    REQUIRE(y[1] == by_hand[1]);
  }
  CHECK(invariant() == doctest::Approx(before).epsilon(1e-12));
  // Work against the old force with the mean velocity is the kinetic energy gained.
  CHECK(std::fabs(0.5 * y[1] * y[1] - kinetic - y[2]) < 1e-12);
}

TEST_CASE("LU with pivoting solves random systems and refuses singular ones") {
  Random r(5);
  for (int n = 1; n < 25; ++n) {
    std::vector<double> a(size_t(n * n)), x(size_t(n), 0.0), b(size_t(n), 0.0);
    for (double& v : a) v = r.uniform(-1, 1);
    if (n > 1) a[0] = 0;  // needs a swap
    for (double& v : x) v = r.uniform(-1, 1);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) b[size_t(i)] += a[size_t(j * n + i)] * x[size_t(j)];
    }
    LuFactor lu;
    REQUIRE(lu.factor(a, n, 0));
    lu.solve(b.data());
    for (int i = 0; i < n; ++i) CHECK(std::fabs(b[size_t(i)] - x[size_t(i)]) < 1e-11);
  }
  LuFactor lu;
  CHECK(!lu.factor(std::vector<double>{1, 2, 2, 4}, 2, 0));
  CHECK(!lu.factor(std::vector<double>{0, 0, 0, 0}, 2, 0));
  CHECK(!lu.factor(std::vector<double>{NAN, 0, 0, 1}, 2, 0));
  CHECK(lu.factor(std::vector<double>{}, 0, 0));
}
