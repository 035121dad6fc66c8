// The scalar force law of coordinates. Reference: the velocity at which free + K F(v) - v changes
// its sign, by bisection on the sum of the parts written out here.
#include "engine/dynamics/joints/force_law.hpp"

#include "engine/core/random.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

struct PlainPart {
  double force, gain, at, least, most;
  bool step;
  double operator()(double v) const {
    if (step) return v < at ? most : least;
    return std::clamp(force - gain * v, least, most);
  }
};

PlainPart random_part(Random& r) {
  const bool step = r.uniform(0, 1) < 0.4;
  PlainPart p{r.uniform(-2, 2), r.uniform(0, 1) < 0.2 ? 0 : r.uniform(0, 3),
              r.uniform(-1, 1), -infinite,
              infinite,         step};
  const bool bounded = step || r.uniform(0, 1) < 0.6;
  if (bounded) p.least = -r.uniform(0, 2), p.most = r.uniform(0, 2);
  if (step && r.uniform(0, 1) < 0.3) p.least = 0, p.most = infinite;
  return p;
}

double by_bisection(const std::vector<PlainPart>& parts, double free, double compliance) {
  double low = -1e3, high = 1e3;
  for (int i = 0; i < 200; ++i) {
    const double v = 0.5 * (low + high);
    double force = 0;
    for (const PlainPart& p : parts) force += p(v);
    (free + compliance * force > v ? low : high) = v;
  }
  return 0.5 * (low + high);
}

}  // namespace

TEST_CASE("a force law is solved exactly, and its parts are within their bounds") {
  Random r(1);
  int held = 0;
  for (int i = 0; i < 5000; ++i) {
    ForceLaw law;
    std::vector<PlainPart> parts;
    const int n = int(r.uniform(0, 6));
    for (int k = 0; k < n; ++k) {
      const PlainPart p = parts.emplace_back(random_part(r));
      if (p.step)
        law.add_step(p.at, p.least, p.most);
      else
        law.add(p.force, p.gain, p.least, p.most);
    }
    const double free = r.uniform(-5, 5), compliance = r.uniform(0.01, 3);
    const ForceLaw::Solution s = law.solve(free, compliance);
    CHECK(std::fabs(s.v - by_bisection(parts, free, compliance)) < 1e-9);
    CHECK(std::fabs(free + compliance * s.force - s.v) < 1e-12);
    double sum = 0;
    for (size_t k = 0; k < parts.size(); ++k) {
      const PlainPart& p = parts[k];
      sum += s.parts[k];
      CHECK(s.parts[k] >= p.least - 1e-12);
      CHECK(s.parts[k] <= p.most + 1e-12);
      if (p.step && s.v == p.at)
        ++held;
      else
        CHECK(std::fabs(s.parts[k] - p(s.v)) < 1e-12);
    }
    CHECK(std::fabs(sum - s.force) < 1e-12);
  }
  CHECK(held > 500);
  CHECK(held < 5000);
}

TEST_CASE("steps at one velocity share the force in their order, nothing moves what is locked") {
  ForceLaw law;
  law.add_step(0, -1, 1);
  law.add_step(0, 0, infinite);
  const ForceLaw::Solution pressed = law.solve(-3, 1);
  CHECK(pressed.v == 0);
  CHECK(pressed.parts[0] == 1);
  CHECK(pressed.parts[1] == 2);
  const ForceLaw::Solution pulled = law.solve(3, 1);
  CHECK(pulled.v == 2);
  CHECK(pulled.parts[0] == -1);
  CHECK(pulled.parts[1] == 0);
  const ForceLaw::Solution locked = law.solve(0.5, 0);
  CHECK(locked.v == 0.5);
  CHECK(locked.force == 0);
}

TEST_CASE("a step without bounds holds the velocity nearest to its own that limits allow") {
  for (const double at : {-2.0, 0.1, 3.0})
    for (const double free : {-5.0, 0.0, 5.0}) {
      ForceLaw law;
      law.add_step(-1, 0, infinite);
      law.add_step(0.5, -infinite, 0);
      law.add_step(at, -infinite, infinite);
      const ForceLaw::Solution s = law.solve(free, 0.7);
      CHECK(s.v == std::clamp(at, -1.0, 0.5));
      CHECK(free + 0.7 * s.force == doctest::Approx(s.v));
      CHECK(s.parts[0] >= 0);
      CHECK(s.parts[1] <= 0);
    }
}
