// The flow of a vortex ring. References: tabulated elliptic integrals (Abramowitz and Stegun,
// tables 17.1 and 17.2), the integral of Biot and Savart by quadrature, closed forms on the axis
// and far away, and the speed of Kelvin's ring.
#include "engine/core/random.hpp"
#include "engine/dynamics/forces/force.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Biot and Savart with distances r^2 + delta^2, by the trapezium rule, which for periodic
/// integrands converges faster than any power.
Vec3 biot_savart(const VortexRingDef& ring, const Vec3& x) {
  const double delta2 = ring.core_radius * ring.core_radius * std::exp(-1.5);
  const Vec3 n = ring.axis.normalized(), u = n.unitOrthogonal(), w = n.cross(u);
  constexpr int steps = 20000;
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < steps; ++i) {
    const double angle = 2 * M_PI * i / steps;
    const Vec3 at = ring.centre + ring.radius * (std::cos(angle) * u + std::sin(angle) * w);
    const Vec3 along = ring.radius * (std::cos(angle) * w - std::sin(angle) * u);
    const Vec3 d = x - at;
    sum += along.cross(d) / std::pow(d.squaredNorm() + delta2, 1.5);
  }
  return ring.circulation / (4 * M_PI) * (2 * M_PI / steps) * sum;
}

VortexRingDef oblique_ring() {
  VortexRingDef ring;
  ring.centre = Vec3(0.3, -0.2, 0.5);
  ring.axis = Vec3(1, 2, -2);
  ring.radius = 0.8;
  ring.circulation = 5;
  ring.core_radius = 0.12;
  return ring;
}

}  // namespace

TEST_CASE("complete elliptic integrals are those of the tables") {
  const double table[][3] = {{0, 1.570796326794897, 1.570796326794897},
                             {0.1, 1.612441348720219, 1.530757636897763},
                             {0.5, 1.854074677301372, 1.350643881047675},
                             {0.9, 2.578092113348173, 1.104774732704073},
                             {0.99, 3.695637362989875, 1.015993545025224}};
  for (const auto& [m, k, e] : table) {
    CHECK(elliptic_integrals(m).k == doctest::Approx(k).epsilon(1e-14));
    CHECK(elliptic_integrals(m).e == doctest::Approx(e).epsilon(1e-14));
  }
}

TEST_CASE("vortex ring: the flow is the integral of Biot and Savart over the circle") {
  const VortexRingDef ring = oblique_ring();
  const auto flow = ring.at(0);
  Random random(4);
  const Vec3 n = ring.axis.normalized(), u = n.unitOrthogonal();
  std::vector<Vec3> points{ring.centre,
                           ring.centre + n,
                           ring.centre + 0.8 * u,
                           ring.centre + 1e-3 * u + 0.4 * n,
                           ring.centre + 2e-5 * u + 0.4 * n,
                           ring.centre + 0.87 * u + 0.03 * n};
  for (int i = 0; i < 40; ++i)
    points.push_back(ring.centre +
                     Vec3(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)));
  for (const Vec3& x : points) {
    const Vec3 exact = biot_savart(ring, x);
    CHECK((flow(x) - exact).norm() < 1e-7 * (exact.norm() + 1e-3));
  }
}

TEST_CASE("vortex ring: circulation about the core, and none about what it does not go round") {
  VortexRingDef ring = oblique_ring();
  ring.core_radius = 0.02;
  const auto flow = ring.at(0);
  const Vec3 n = ring.axis.normalized(), u = n.unitOrthogonal();
  const auto circulation = [&](const Vec3& middle, double r) {
    constexpr int steps = 4000;
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const double a = 2 * M_PI * i / steps;
      // From along the axis, inside the ring, outwards on its far side: with the flow.
      const Vec3 out = std::cos(a) * u + std::sin(a) * n;
      sum += flow(middle + r * out).dot(std::cos(a) * n - std::sin(a) * u) * r * 2 * M_PI / steps;
    }
    return sum;
  };
  // What Rosenhead's distances leave of it within 20 delta.
  CHECK(circulation(ring.centre + ring.radius * u, 0.3) == doctest::Approx(-5).epsilon(0.01));
  CHECK(std::fabs(circulation(ring.centre + 2.5 * u, 0.3)) < 1e-3);
}

TEST_CASE("vortex ring: the flow on the circle carries it with the speed that Kelvin gave") {
  for (const double core : {0.1, 0.03, 0.01}) {
    VortexRingDef ring = oblique_ring();
    ring.core_radius = core;
    const double slimness = core / ring.radius;
    const double kelvin = 5 / (4 * M_PI * 0.8) * (std::log(8 / slimness) - 0.25);
    CHECK(ring.speed() == doctest::Approx(kelvin).epsilon(1e-12));
    const Vec3 n = ring.axis.normalized();
    const Vec3 u = ring.at(0)(ring.centre + ring.radius * n.unitOrthogonal());
    // Both hold for thin rings, to the square of their slimness.
    CHECK((u - kelvin * n).norm() < 2 * slimness * slimness * kelvin);
    // And there it goes.
    const auto later = ring.at(1.5);
    CHECK((later.rings[0].centre - ring.centre - 1.5 * kelvin * n).norm() < 1e-12);
  }
}

TEST_CASE(
    "vortex ring: no divergence, a dipole far away, still before its start, weaker by decay") {
  VortexRingDef ring = oblique_ring();
  const auto flow = ring.at(0);
  Random random(9);
  for (int i = 0; i < 200; ++i) {
    const Vec3 x(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5));
    double divergence = 0;
    const double h = 1e-3;
    for (int k = 0; k < 3; ++k) {
      const Vec3 e = h * Vec3::Unit(k);
      divergence +=
          (8 * (flow(x + e)[k] - flow(x - e)[k]) - (flow(x + 2 * e)[k] - flow(x - 2 * e)[k])) /
          (12 * h);
    }
    CHECK(std::fabs(divergence) < 1e-4);
  }
  const Vec3 n = ring.axis.normalized(), far = 60 * Vec3(0.6, 0, 0.8);
  const Vec3 moment = 5 * M_PI * 0.64 * n, out = far.normalized();
  const Vec3 dipole = (3 * moment.dot(out) * out - moment) / (4 * M_PI * std::pow(60, 3));
  CHECK((flow(ring.centre + far) - dipole).norm() < 2e-3 * dipole.norm());

  ring.start = 2;
  ring.decay = 0.5;
  CHECK(ring.at(1.9)(Vec3(0.1, 0.2, 0.3)) == Vec3::Zero());
  const auto late = ring.at(4);  // two seconds old
  CHECK(late.rings[0].factor == doctest::Approx(5 / (2 * M_PI) * std::exp(-1)).epsilon(1e-12));
  CHECK((late.rings[0].centre - ring.centre).norm() ==
        doctest::Approx(ring.speed() * (1 - std::exp(-1)) / 0.5).epsilon(1e-12));
  ring.decay = 1e-9;
  CHECK((ring.at(4).rings[0].centre - ring.centre).norm() ==
        doctest::Approx(2 * ring.speed()).epsilon(1e-8));
}

TEST_CASE("vortex rings one after the other: the flow is the sum of those that have started") {
  VortexRingDef three = oblique_ring();
  three.count = 3;
  three.every = 0.5;
  three.decay = 0.2;
  const Vec3 x(0.4, 0.1, 0.9);
  for (const double t : {0.1, 0.6, 1.3, 4.0}) {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      VortexRingDef one = three;
      one.count = 1;
      one.start = 0.5 * i;
      sum += one.at(t)(x);
    }
    CHECK((three.at(t)(x) - sum).norm() < 1e-14 * sum.norm());
    CHECK(three.at(t).count == std::min(3, 1 + int(t / 0.5)));
  }
}

TEST_CASE("vortex ring: what is wrong with it is said") {
  VortexRingDef ring;
  CHECK(ring.fault().empty());
  ring.core_radius = 0.6;
  CHECK(ring.fault().find("core_radius") != std::string::npos);
  ring = {};
  ring.axis = Vec3::Zero();
  CHECK(ring.fault().find("axis") != std::string::npos);
}
