// Fields of force and of flow. References: closed forms (Kepler, harmonic motion, circulation of
// the Lamb-Oseen vortex, terminal velocity), and finite differences of the fields themselves for
// what must follow from each other: acceleration = -grad potential, divergence of flows = 0.
#include "engine/core/random.hpp"
#include "engine/dynamics/forces/force.hpp"
#include "tests/dynamics/piles.hpp"

#include <cmath>
#include <type_traits>

#include <doctest/doctest.h>

using namespace tumble;
using test::scaled;

namespace {

Vec3 random_point(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

/// Sixth-order central differences.
template <class F>
std::invoke_result_t<F, double> difference(F f, double h) {
  return (1.5 * (f(h) - f(-h)) - 0.3 * (f(2 * h) - f(-2 * h)) + (f(3 * h) - f(-3 * h)) / 30) /
         (2 * h);
}

template <class Field>
void check_gradient(const Field& field, double size) {
  Random random(11);
  for (int i = 0; i < scaled(2000, 50); ++i) {
    const Vec3 x = random_point(random, size);
    const Vec3 a = field.acceleration(x);
    const double near = (x - field.centre).norm();
    for (int k = 0; k < 3; ++k) {
      const double slope =
          difference([&](double s) { return field.potential(x + s * Vec3::Unit(k)); },
                     1e-3 * std::min(1.0, near + 0.05));
      CHECK(-slope == doctest::Approx(a[k]).epsilon(1e-8).scale(a.norm() + 1e-3));
    }
  }
}

template <class Flow>
double divergence(const Flow& flow, const Vec3& x, double h) {
  double sum = 0;
  for (int k = 0; k < 3; ++k)
    sum += difference([&](double s) { return flow(x + s * Vec3::Unit(k))[k]; }, h);
  return sum;
}

}  // namespace

TEST_CASE("acceleration is minus the gradient of the potential, by finite differences") {
  PointGravityDef gravity;
  gravity.centre = Vec3(0.3, -0.2, 0.1);
  gravity.mu = 3;
  check_gradient(gravity, 2);
  gravity.softening = 0.4;
  check_gradient(gravity, 2);
  AttractorDef attractor;
  attractor.centre = Vec3(-0.1, 0.4, 0.2);
  check_gradient(attractor, 2);
  attractor.radius = 0.7;
  check_gradient(attractor, 2);
  RepulsorDef repulsor;
  repulsor.centre = Vec3(0.5, 0, 0.2);
  repulsor.radius = 0.8;
  check_gradient(repulsor, 2);
}

TEST_CASE("at its centre every field of force is finite") {
  PointGravityDef gravity;
  CHECK(gravity.acceleration(gravity.centre) == Vec3::Zero());
  CHECK(gravity.potential(gravity.centre) == 0);
  CHECK(AttractorDef{}.acceleration(Vec3::Zero()) == Vec3::Zero());
  CHECK(RepulsorDef{}.acceleration(Vec3::Zero()) == Vec3::Zero());
}

TEST_CASE("vortex: the line integral around a circle is Gamma (1 - exp(-r^2/a^2))") {
  VortexDef vortex;
  vortex.axis = Vec3(1, 2, -2);
  vortex.centre = Vec3(0.2, 0.3, -0.1);
  vortex.circulation = 7;
  vortex.core_radius = 0.6;
  vortex.strain = 0.9;
  const auto flow = vortex.at(0);
  const Vec3 n = vortex.axis.normalized(), u = n.unitOrthogonal(), w = n.cross(u);
  for (const double r : {1e-5, 0.01, 0.3, 0.6, 2.0, 50.0}) {
    constexpr int steps = 64;
    double circulation = 0, inward = 0;
    for (int i = 0; i < steps; ++i) {
      const double angle = 2 * M_PI * i / steps;
      const Vec3 out = std::cos(angle) * u + std::sin(angle) * w;
      const Vec3 v = flow(vortex.centre + r * out + 0.7 * n);
      circulation += v.dot(n.cross(out)) * r * 2 * M_PI / steps;
      inward += v.dot(out) / steps;
      CHECK(v.dot(n) == doctest::Approx(0.9 * 0.7));
    }
    CHECK(circulation == doctest::Approx(-7 * std::expm1(-r * r / 0.36)).epsilon(1e-10));
    CHECK(inward == doctest::Approx(-0.45 * r));
  }
  Random random(3);
  for (int i = 0; i < scaled(500, 20); ++i)
    CHECK(std::fabs(divergence(flow, random_point(random, 2), 1e-2)) < 1e-6);
}

TEST_CASE("turbulence has no divergence, the asked speed, and changes with time and seed only") {
  TurbulenceDef turbulence;
  turbulence.speed = 3;
  turbulence.size = 0.8;
  turbulence.octaves = 3;
  const auto flow = turbulence.at(1.3);
  Random random(5);
  double square = 0, gradient = 0, worst = 0;
  const int n = scaled(40000, 2000);
  for (int i = 0; i < n; ++i) {
    const Vec3 x = random_point(random, 40);
    square += flow(x).squaredNorm() / n;
    // Differences across a face of the lattice see its jump of the third derivative.
    if (i % 8 == 0) {
      worst = std::max(worst, std::fabs(divergence(flow, x, 1e-4)));
      gradient = std::max(
          gradient, difference([&](double s) { return flow(x + s * Vec3::UnitX()); }, 1e-4).norm());
    }
  }
  CHECK(gradient > 5);
  CHECK(worst < 1e-6 * gradient);
  CHECK(std::sqrt(square) == doctest::Approx(3).epsilon(n > 20000 ? 0.02 : 0.3));
  const Vec3 x(1.23, 4.5, -6.7);
  CHECK(turbulence.at(1.3)(x) == flow(x));
  CHECK((turbulence.at(1.31)(x) - flow(x)).norm() > 0);
  CHECK((turbulence.at(1.3 + turbulence.period)(x) - flow(x)).norm() < 1e-12);
  turbulence.period = 0;
  CHECK(turbulence.at(5)(x) == turbulence.at(50)(x));
  turbulence.seed = 2;
  CHECK((turbulence.at(1.3)(x) - flow(x)).norm() > 0.01);
  CHECK(flow(Vec3(1e300, 0, 0)) == Vec3::Zero());
}

TEST_CASE("turbulence is continuous across the cells of its lattice, with its first derivatives") {
  TurbulenceDef turbulence;
  turbulence.octaves = 1;
  const auto flow = turbulence.at(0.4);
  Random random(8);
  for (int i = 0; i < scaled(300, 20); ++i) {
    const Vec3 x(std::floor(random.uniform(-9, 9)), random.uniform(-9, 9), random.uniform(-9, 9));
    const Vec3 step(1e-6, 0, 0);
    CHECK((flow(x + step) - flow(x - step)).norm() < 1e-4);
    const Vec3 left = flow(x - step) - flow(x - 2 * step),
               right = flow(x + 2 * step) - flow(x + step);
    CHECK((right - left).norm() < 1e-9);  // a jump of the slope would give 1e-6 of it
  }
}

TEST_CASE("gusts stay within their share, and travel with the wind") {
  WindDef wind;
  wind.velocity = Vec3(6, 0, 2);
  wind.gusts = 0.5;
  double low = 10, high = 0;
  for (int i = 0; i < 2000; ++i) {
    const double s = wind.at(0.05 * i)(Vec3::Zero()).norm() / wind.velocity.now().norm();
    low = std::min(low, s);
    high = std::max(high, s);
  }
  CHECK(low > 0.5 - 1e-12);
  CHECK(low < 0.6);
  CHECK(high < 1.5 + 1e-12);
  CHECK(high > 1.4);
  const Vec3 there(0.7, 0.3, 2.1);
  const Vec3 now = wind.at(3)(there);
  const Vec3 later = wind.at(3.5)(there + 0.5 * wind.velocity.now());
  CHECK((now - later).norm() < 1e-12);
}

TEST_CASE("what a flow does in a tick is the solution of dw/dt = -(c + k |w|) w") {
  // Reference: classical Runge-Kutta in small steps.
  const Vec3 w0(3, -1, 2);
  const auto rate_of = [](const Vec3& w, double c, double k) -> Vec3 {
    return -(c + k * w.norm()) * w;
  };
  for (const double c : {0.0, 1e-7, 0.5, 20.0}) {
    for (const double k : {0.0, 0.3, 5.0}) {
      const double h = 0.1;
      Vec3 w = w0;
      for (int i = 0; i < 2000; ++i) {
        const double s = h / 2000;
        const Vec3 k1 = rate_of(w, c, k), k2 = rate_of(w + s / 2 * k1, c, k),
                   k3 = rate_of(w + s / 2 * k2, c, k), k4 = rate_of(w + s * k3, c, k);
        w += s / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      }
      const Vec3 got = w0 - h * flow_acceleration(w0, c, k, h);
      CHECK((got - w).norm() < 1e-11);
      CHECK((flow_acceleration(w0, c, k, 0) + rate_of(w0, c, k)).norm() < 1e-12);
    }
  }
  CHECK((w0 - 0.1 * flow_acceleration(w0, 1e9, 1e9, 0.1)).norm() < 1e-6);
}
