// Hostile input, memory and bits. References: what the interface promises; counts of operator new;
// a hash of the state that every compiler must reach.
#include "engine/core/hash.hpp"
#include "tests/math/ode_problems.hpp"

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::ode;
using namespace tumble::ode::test;

namespace {

std::atomic<uint64_t> allocations{0};

/// Fails in one entry from a time on.
struct Faulty : Oscillator {
  double from = 0.5, value = std::numeric_limits<double>::quiet_NaN();
  bool refuse = false;
  bool derivative(double t, std::span<const double> y, std::span<double> d) override {
    Oscillator::derivative(t, y, d);
    if (t >= from) {
      if (refuse) return false;
      d[1] = value;
    }
    return true;
  }
  std::string entry_name(size_t i) const override { return i == 1 ? "the velocity" : "another"; }
};

}  // namespace

// Not inlined: g++ would take malloc and delete for a mismatched pair.
[[gnu::noinline]] void* operator new(size_t size) {
  ++allocations;
  if (void* p = std::malloc(size ? size : 1)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, size_t) noexcept {
  std::free(p);
}

TEST_CASE(
    "a derivative that is not finite is refused, names its entry and leaves the state alone") {
  for (const IntegratorEntry& e : all_integrators()) {
    CAPTURE(e.name);
    for (const double value :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()}) {
      Faulty problem;
      problem.value = value;
      const auto integrator = e.make();
      State y = problem.start();
      const StepReport r = integrator->step(problem, 0.5, 0.1, y);
      CHECK(r.status == StepStatus::non_finite);
      CHECK(r.component == 1);
      CHECK(y == problem.start());
      const std::string text = r.text(e.name, problem).text();
      CHECK(text.find("the velocity") != std::string::npos);
      CHECK(text.find(e.name) != std::string::npos);
      // Met on the way: an adaptive step creeps up to it and no farther.
      if (integrator->adaptive()) {
        const StepReport way = integrator->advance(problem, 0, 1, y);
        CHECK(way.status == StepStatus::non_finite);
        CHECK(way.component == 1);
        CHECK(y == problem.start());
      }
    }
    Faulty problem;
    problem.refuse = true;
    const auto integrator = e.make();
    State y = problem.start();
    CHECK(integrator->step(problem, 0.5, 0.1, y).status == StepStatus::refused);
    CHECK(y == problem.start());
  }
}

TEST_CASE("states, times and steps that are no numbers are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const IntegratorEntry& e : all_integrators()) {
    CAPTURE(e.name);
    Oscillator problem;
    const auto integrator = e.make();
    State y = problem.start();
    for (const double bad : {nan, inf, -inf}) {
      CHECK(integrator->step(problem, 0, bad, y).status == StepStatus::bad_input);
      CHECK(integrator->step(problem, bad, 0.1, y).status == StepStatus::bad_input);
      CHECK(integrator->advance(problem, 0, bad, y).status == StepStatus::bad_input);
    }
    CHECK(y == problem.start());
    State two(2, 0.0), broken = y;
    CHECK(integrator->step(problem, 0, 0.1, two).status == StepStatus::bad_input);
    broken[2] = nan;
    const StepReport r = integrator->step(problem, 0, 0.1, broken);
    CHECK(r.status == StepStatus::bad_state);
    CHECK(r.component == 2);
    CHECK(broken[0] == y[0]);
  }
}

TEST_CASE("values that overflow within a step are refused") {
  for (const IntegratorEntry& e : all_integrators()) {
    CAPTURE(e.name);
    Oscillator problem;
    const auto integrator = e.make();
    State y{1e308, -1e308, 0};
    const State before = y;
    const StepReport r = integrator->step(problem, 0, 1e10, y);
    CHECK(!r.ok());
    CHECK(y == before);
  }
}

TEST_CASE(
    "tolerances that are no numbers, negative or zero allow no step, a remembered step may be") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, -1.0, 0.0}) {
    CAPTURE(bad);
    for (const IntegratorEntry& e : all_integrators()) {
      CAPTURE(e.name);
      Oscillator problem;
      const auto integrator = e.make();
      integrator->settings.tolerance = integrator->settings.newton = {bad, bad, bad};
      State y = problem.start();
      const StepReport r = integrator->advance(problem, 0, 0.1, y);
      const bool reads = integrator->adaptive() || e.name == "implicit_euler";
      CHECK(r.ok() == !reads);
      if (!reads) continue;
      CHECK(r.status == StepStatus::bad_tolerance);
      CHECK(r.text(e.name, problem).text().find("must be > 0") != std::string::npos);
      CHECK(y == problem.start());
    }
  }
  for (const double h : {nan, -1.0, std::numeric_limits<double>::infinity()}) {
    Oscillator problem;
    const auto integrator = all_integrators().back().make();
    integrator->set_adaptive_state({h, nan});
    State y = problem.start();
    CHECK(integrator->advance(problem, 0, 3, y).ok());
    CHECK(difference(y, problem.exact(3)) < 1e-7);
  }
}

TEST_CASE("a step of zero leaves every bit as it is and asks for no derivative") {
  for (const IntegratorEntry& e : all_integrators()) {
    Faulty problem;
    const auto integrator = e.make();
    State y = problem.start(), at(3);
    const StepReport r = integrator->step(problem, 1, 0, y);
    CHECK(r.ok());
    CHECK(r.evaluations == 0);
    CHECK(r.advanced == 0);
    CHECK(y == problem.start());
    integrator->at(problem, 1, at);
    CHECK(at == y);
    CHECK(integrator->advance(problem, 1, 0, y).ok());
  }
}

TEST_CASE("a system of no entries is stepped by everyone who needs no split") {
  struct Nothing : System {
    size_t size() const override { return 0; }
    bool derivative(double, std::span<const double>, std::span<double>) override { return true; }
  } problem;
  for (const IntegratorEntry& e : all_integrators()) {
    const auto integrator = e.make();
    CHECK(integrator->advance(problem, 0, 1, {}).ok());
  }
}

TEST_CASE("semi-implicit Euler refuses a system that names no positions and momenta") {
  struct Plain : System {
    size_t size() const override { return 1; }
    bool derivative(double, std::span<const double>, std::span<double> d) override {
      d[0] = 1;
      return true;
    }
  } problem;
  for (const IntegratorEntry& e : all_integrators()) {
    const auto integrator = e.make();
    State y{0};
    const StepReport r = integrator->step(problem, 0, 1, y);
    CHECK(r.ok() == (e.name != "semi_implicit_euler"));
    if (!r.ok()) CHECK(r.status == StepStatus::no_split);
  }
}

TEST_CASE("steps in a row do not allocate") {
  for (const IntegratorEntry& e : all_integrators()) {
    CAPTURE(e.name);
    struct Bare : Oscillator {
      size_t size() const override { return 3; }
    } problem;
    const auto integrator = e.make();
    State y = problem.start(), at(3);
    for (int i = 0; i < 2; ++i) REQUIRE(integrator->advance(problem, 0, 20, y).ok());
    const uint64_t before = allocations;
    bool ok = true;
    for (int i = 0; i < 20; ++i) {
      ok = ok && integrator->advance(problem, i, i % 2 ? 1 : 20, y).ok();
      integrator->at(problem, i + 0.5, at);
    }
    CHECK(allocations == before);
    CHECK(ok);
  }
}

TEST_CASE("every compiler reaches the same bits") {
  uint64_t hash = 0;
  for (const IntegratorEntry& e : all_integrators()) {
    Kepler orbit(0.25);
    FreeTop top;
    const auto integrator = e.make();
    State y{0.75, 0, 0, 1.25, 0}, z{1, 0, 0, 0, 0.1, 1.5, 0.2};
    for (int i = 0; i < 100; ++i) {
      CAPTURE(e.name);
      const StepReport r = integrator->advance(orbit, i / 64.0, 1 / 64.0, y);
      REQUIRE_MESSAGE(r.ok(), r.text(e.name, orbit).text());
      REQUIRE(integrator->advance(top, i / 64.0, 1 / 64.0, z).ok());
    }
    hash = hash_bytes(y.data(), y.size() * sizeof(double), hash);
    hash = hash_bytes(z.data(), z.size() * sizeof(double), hash);
  }
  CHECK(hash_text(hash) == "7e82b7bcb100058a");
}
