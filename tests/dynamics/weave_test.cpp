// Cloths, nets and ropes as they are woven, and the system of their springs. References: the closed
// form of the catenary; masses and energies summed by hand over a homogeneous strain or curvature
// (plate theory); SpringNet::solve, which takes the same net without a matrix and to 1e-8.
#include "engine/dynamics/forces/weave.hpp"

#include "engine/core/random.hpp"
#include "engine/dynamics/forces/spring_net.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

/// Energy of a weave whose own nodes are at places[i].
double energy(const Weave& weave, const std::vector<Vec3>& places) {
  double sum = 0;
  for (const SpringMesh::Link& l : weave.mesh.links) {
    const double stretch = (places[l.b] - places[l.a]).norm() - l.rest_length;
    sum += 0.5 * l.stiffness * stretch * stretch;
  }
  for (const SpringMesh::Bend& b : weave.mesh.bends) {
    Vec3 q = Vec3::Zero();
    for (uint32_t k = 0; k < b.count; ++k) q += b.weight[k] * places[b.node[k]];
    sum += 0.5 * b.stiffness * q.squaredNorm();
  }
  return sum;
}

std::vector<Vec3> places(const Weave& weave) {
  std::vector<Vec3> out;
  for (const ParticleDef& p : weave.particles) out.push_back(p.x);
  return out;
}

ClothDef cloth(int columns, int rows) {
  ClothDef d;
  d.sheet.across = Vec3(1.2, 0, 0);
  d.sheet.down = Vec3(0, 0, 0.9);
  d.sheet.columns = columns;
  d.sheet.rows = rows;
  d.density = 0.3, d.stretch = 250, d.shear = 40, d.bend = 0.02;
  return d;
}

}  // namespace

TEST_CASE("a cloth has the mass of its area, at any number of nodes") {
  for (const int n : {5, 13, 25}) {
    const auto weave = weave_cloth(cloth(n, n));
    REQUIRE(weave.ok());
    double mass = 0;
    for (const ParticleDef& p : weave->particles) mass += p.mass;
    CHECK(mass == doctest::Approx(0.3 * 1.2 * 0.9).epsilon(1e-12));
    CHECK(energy(*weave, places(*weave)) < 1e-25);
  }
}

TEST_CASE("a strip that is pulled along its threads has the modulus that was given") {
  // Uniaxial tension: the strain across that takes the least energy, found by a parabola.
  for (const auto& [columns, rows] : {std::pair{13, 10}, {9, 8}, {25, 19}}) {
    const auto weave = weave_cloth(cloth(columns, rows));
    REQUIRE(weave.ok());
    for (const int axis : {0, 2}) {
      const double strain = 1e-4;
      const auto at = [&](double across) {
        std::vector<Vec3> x = places(*weave);
        for (Vec3& p : x) {
          p[axis] *= 1 + strain;
          p[2 - axis] *= 1 + across;
        }
        return energy(*weave, x);
      };
      const double lower = at(-strain), middle = at(0), upper = at(strain);
      const double curve = lower - 2 * middle + upper, slope = 0.5 * (upper - lower);
      const double least = middle - 0.5 * slope * slope / curve;
      CHECK(least == doctest::Approx(0.5 * 250 * strain * strain * 1.2 * 0.9).epsilon(1e-3));
    }
  }
}

TEST_CASE("the energy of shear is that of the shear modulus") {
  const auto weave = weave_cloth(cloth(13, 10));
  REQUIRE(weave.ok());
  std::vector<Vec3> x = places(*weave);
  const double angle = 1e-4;
  for (Vec3& p : x) p.x() += angle * p.z();
  CHECK(energy(*weave, x) == doctest::Approx(0.5 * 40 * angle * angle * 1.2 * 0.9).epsilon(1e-3));
}

TEST_CASE("a sheet rolled onto a cylinder has the energy of its curvature, along any direction") {
  // Isometric, so only bending counts: D/2 k^2 per area, to first order in the spacing.
  for (const double turn : {0.0, 0.5, 1.2}) {
    double before = 1;
    for (const int n : {12, 24, 48}) {
      ClothDef d = cloth(4 * n + 1, 3 * n + 1);
      d.shear = 0;
      d.stretch = 1e-12;
      const auto weave = weave_cloth(d);
      REQUIRE(weave.ok());
      std::vector<Vec3> x = places(*weave);
      const double radius = 2;
      for (Vec3& p : x) {
        const double along = std::cos(turn) * p.x() + std::sin(turn) * p.z();
        const double beside = -std::sin(turn) * p.x() + std::cos(turn) * p.z();
        p = Vec3(radius * std::sin(along / radius), radius * std::cos(along / radius), beside);
      }
      const double expected = 0.5 * 0.02 / (radius * radius) * 1.2 * 0.9;
      const double error = std::fabs(energy(*weave, x) / expected - 1);
      CHECK(error < 0.6 * before);
      before = error;
    }
    CHECK(before < 0.05);
  }
}

TEST_CASE("a slack rope starts as a catenary") {
  const Vec3 a(-1, 0.3, 0.2), b(1.4, -0.4, 0.9);
  const double slack = 1.2;
  const std::vector<Vec3> x = hanging_points(a, b, Vec3(0, -9.81, 0), slack, 400);
  REQUIRE(x.size() == 401);
  CHECK((x.front() - a).norm() < 1e-12);
  CHECK((x[399] - b).norm() < 1.1 * slack * (b - a).norm() / 400);
  double length = 0, span = std::hypot(b.x() - a.x(), b.z() - a.z());
  for (size_t i = 0; i + 1 < x.size(); ++i) length += (x[i + 1] - x[i]).norm();
  CHECK(length == doctest::Approx(slack * (b - a).norm()).epsilon(1e-4));
  // y'' = sqrt(1 + y'^2)/c with one c everywhere: the horizontal tension is the same.
  const auto level = [&](const Vec3& p) { return std::hypot(p.x() - a.x(), p.z() - a.z()); };
  CHECK(level(x[400]) == doctest::Approx(span).epsilon(1e-9));
  double first = 0;
  for (size_t i = 20; i + 20 < x.size(); i += 40) {
    const double s0 = (x[i + 1].y() - x[i].y()) / (level(x[i + 1]) - level(x[i]));
    const double s1 = (x[i + 2].y() - x[i + 1].y()) / (level(x[i + 2]) - level(x[i + 1]));
    const double c = length / 400 / (s1 - s0);
    if (first == 0) first = c;
    CHECK(c == doctest::Approx(first).epsilon(1e-3));
  }
}

TEST_CASE("what cannot be woven is refused in words") {
  ClothDef narrow = cloth(1, 5), skew = cloth(5, 5), long_cells = cloth(3, 40),
           pinned = cloth(5, 5);
  skew.sheet.down = Vec3(0.5, 0, 0.9);
  long_cells.shear = 100;
  pinned.sheet.pins.push_back({7, 0, {}});
  for (const ClothDef& d : {narrow, skew, long_cells, pinned}) {
    const auto weave = weave_cloth(d);
    REQUIRE_FALSE(weave.ok());
    CHECK(weave.error().message.size() > 20);
  }
  RopeDef rope;
  CHECK_FALSE(weave_rope(rope).ok());
  rope.places = {{false, {}, Vec3::Zero()}, {true, {}, Vec3(1, 0, 0)}};
  CHECK(weave_rope(rope).ok());
  rope.slack = 0.5;
  CHECK_FALSE(weave_rope(rope).ok());
}

TEST_CASE("the system of a mesh and the net without a matrix give the same pulls") {
  Random random(5);
  const auto vector = [&random](double size) -> Vec3 {
    return size * Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (const double stiffness : {10.0, 1e3, 1e5}) {
    SpringNet net;
    net.h = 1.0 / 60;
    net.lead = 0.5 * net.h;
    for (int i = 0; i < 24; ++i) {
      SpringNet::Node& n = net.nodes.emplace_back();
      n.mass = random.uniform(0.1, 3);
      n.turns = i % 3 == 0;
      n.meshed = true;
      n.x = vector(1);
      if (n.turns) n.inertia = Vec3(0.02, 0.03, 0.04).asDiagonal();
      n.omega = n.turns ? vector(3) : Vec3::Zero();
      n.dv_free = vector(0.2);
      if (n.turns) n.domega_free = vector(0.2);
    }
    for (int i = 0; i < 60; ++i) {
      SpringNet::Tie& t = net.ties.emplace_back();
      const auto end = [&](uint32_t node) {
        SpringNet::End e{node, Vec3::Zero(), 1 / net.nodes[node].mass};
        if (net.nodes[node].turns) e.arm = vector(0.3);
        return e;
      };
      t.a = i == 0 ? SpringNet::End{} : end(uint32_t(i % 24));  // held: no rigid motion is added
      t.b = end((uint32_t(i) + 1 + random.below(23)) % 24);
      t.d = vector(1), t.dv = vector(2);
      t.stiffness = stiffness * random.uniform(0.5, 2);
      t.damping = 1;
      t.rest_length = random.uniform(0, 1.5);
    }
    std::vector<SpringNet::Pull> pulls;
    net.solve(pulls);
    SpringNet::Answer answer;
    net.solve_meshed(answer);
    CHECK(answer.report.residual <= 3e-3);
    // By what they do to the nodes in all: the rest belongs to nobody.
    std::vector<Vec3> expected(24, Vec3::Zero()), found = answer.rest_force;
    double size = 0;
    for (size_t i = 0; i < pulls.size(); ++i) {
      expected[net.ties[i].b.node] -= pulls[i].force;
      found[net.ties[i].b.node] -= answer.ties[i].force;
      if (net.ties[i].a.node == SpringNet::fixed) continue;
      expected[net.ties[i].a.node] += pulls[i].force;
      found[net.ties[i].a.node] += answer.ties[i].force;
    }
    double error = 0;
    for (size_t k = 0; k < 24; ++k) {
      error += (found[k] - expected[k]).squaredNorm();
      size += expected[k].squaredNorm();
    }
    CHECK(std::sqrt(error / size) < 2e-2);
  }
}
