// Complementarity with cones. References: closed forms (a block on a slope, a sliding rod, a
// table), a search over all directions with bisection (one group, any matrix), and the validator.
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/solvers.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/lcp_families.hpp"
#include "tests/support/why_not.hpp"

#include <map>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;
using namespace tumble::lcp_families;

namespace {

constexpr double cone_pi = 3.14159265358979323846;

LcpSolution cone_solve(std::string_view name, const LcpProblem& p, double tolerance = 1e-9) {
  LcpOptions options;
  options.tolerance = tolerance;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    if (e.name != name) continue;
    auto s = e.solve(p, options);
    REQUIRE_MESSAGE(s.ok(), test::why_not(s));
    CHECK(s->report.residual == validate(p, s->z).worst());
    if (s->report.solved()) CHECK(s->report.residual <= tolerance);
    return std::move(*s);
  }
  FAIL("no such solver");
  return {};
}

/// One group with its own 3 x 3 matrix.
LcpProblem one_group(const MatX& A, const VecX& b, double slope) {
  LcpProblem p = LcpProblem::plain(A, b);
  p.lower[1] = p.lower[2] = -inf;
  ConeGroup g;
  g.axial = 0;
  g.lateral = {1, 2};
  g.slope = slope;
  p.groups.push_back(g);
  return p;
}

/// What is wrong with sliding in direction (cos, sin) of z: the part of w across it; also the part
/// along it, which must be negative, and z_a, which must be positive.
struct SlipTrial {
  double across, along, axial;
};

SlipTrial slip(const LcpProblem& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), mu = p.groups[0].slope;
  double f[3], w[3];
  for (int i = 0; i < 3; ++i) f[i] = p.A(i, 0) + mu * (c * p.A(i, 1) + s * p.A(i, 2));
  const double a = -p.b[0] / f[0];
  for (int i = 0; i < 3; ++i) w[i] = f[i] * a + p.b[i];
  return {c * w[2] - s * w[1], c * w[1] + s * w[2], a};
}

/// All solutions of one group with a definite matrix, by search.
std::vector<VecX> all_of_one_group(const LcpProblem& p) {
  std::vector<VecX> out;
  const double mu = p.groups[0].slope;
  if (p.b[0] >= 0) out.push_back(VecX::Zero(3));
  const MatX& A = p.A;
  const double det = A(0, 0) * (A(1, 1) * A(2, 2) - A(1, 2) * A(2, 1)) -
                     A(0, 1) * (A(1, 0) * A(2, 2) - A(1, 2) * A(2, 0)) +
                     A(0, 2) * (A(1, 0) * A(2, 1) - A(1, 1) * A(2, 0));
  VecX stick(3);
  for (int k = 0; k < 3; ++k) {
    MatX B = A;
    B.col(k) = -p.b;
    stick[k] = (B(0, 0) * (B(1, 1) * B(2, 2) - B(1, 2) * B(2, 1)) -
                B(0, 1) * (B(1, 0) * B(2, 2) - B(1, 2) * B(2, 0)) +
                B(0, 2) * (B(1, 0) * B(2, 1) - B(1, 1) * B(2, 0))) /
               det;
  }
  if (stick[0] >= 0 && std::hypot(stick[1], stick[2]) <= mu * stick[0]) out.push_back(stick);
  constexpr int steps = 2000;
  for (int k = 0; k < steps; ++k) {
    double lo = 2 * cone_pi * k / steps, hi = 2 * cone_pi * (k + 1) / steps;
    const SlipTrial a = slip(p, lo), b = slip(p, hi);
    if (a.axial <= 0 || b.axial <= 0 || a.across * b.across > 0) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (lo + hi);
      (slip(p, middle).across * a.across > 0 ? lo : hi) = middle;
    }
    const SlipTrial t = slip(p, lo);
    if (t.along > 1e-12) continue;
    VecX z(3);
    z << t.axial, mu * t.axial * std::cos(lo), mu * t.axial * std::sin(lo);
    out.push_back(z);
  }
  return out;
}

}  // namespace

TEST_CASE("a block on a slope sticks and slides alike in every direction") {
  for (const char* name : {"baraff", "cone_newton", "cone_interior", "pgs"}) {
    for (int k = 0; k < 64; ++k) {
      const double azimuth = 2 * cone_pi * k / 64, mu = 0.5, mass = 3;
      for (const double tangent : {0.1, 0.5 - 1e-6, 0.5 + 1e-6, 0.7, 3.0}) {
        const double down = 9.81 / std::sqrt(1 + tangent * tangent), along = tangent * down;
        VecX b(3), z(3);
        b << -down, along * std::cos(azimuth), along * std::sin(azimuth);
        const LcpProblem p = one_group(MatX::Identity(3, 3) / mass, b, mu);
        const LcpSolution s = cone_solve(name, p);
        const double held = std::min(along, mu * down) * mass;
        z << down * mass, -held * std::cos(azimuth), -held * std::sin(azimuth);
        CAPTURE(name);
        CHECK(s.report.solved());
        CHECK(s.report.solver == name);
        CHECK((s.z - z).norm() < (std::string(name) == "pgs" ? 1e-7 : 1e-11));
        const double slips = std::hypot(s.w[1], s.w[2]);
        CHECK(std::fabs(slips - std::max(0.0, along - mu * down)) < 1e-8);
      }
    }
  }
}

TEST_CASE("a pyramid holds more along its diagonal, a prescribed direction is obeyed") {
  VecX b(3);
  b << -1, 0.6 * std::sqrt(0.5), 0.6 * std::sqrt(0.5);
  LcpProblem p = one_group(MatX::Identity(3, 3), b, 0.5);
  p.groups[0].shape = ConeShape::pyramid;
  for (const char* name : {"baraff", "cone_newton", "cone_interior", "pgs"}) {
    CAPTURE(name);
    const LcpSolution s = cone_solve(name, p);
    CHECK(s.report.solved());
    CHECK((s.z + b).norm() < 1e-8);  // sticks, though 0.6 > 0.5
  }
  p.b[1] = 0.8;
  for (const char* name : {"baraff", "cone_newton", "cone_interior", "pgs"}) {
    CAPTURE(name);
    const LcpSolution s = cone_solve(name, p);
    CHECK(std::fabs(s.z[1] + 0.5) < 1e-8);
    CHECK(std::fabs(s.z[2] + b[2]) < 1e-8);
  }
  p.groups[0].mode = ConeMode::sliding;
  p.groups[0].direction = {0.6, 0.8};
  for (const char* name : {"baraff", "cone_newton", "cone_interior", "pgs", "lemke"}) {
    CAPTURE(name);
    const LcpSolution s = cone_solve(name, p);
    CHECK((s.z - (VecX(3) << 1, -0.3, -0.4).finished()).norm() < 1e-8);
  }
}

TEST_CASE("one group with any definite matrix: solvers find one of all solutions") {
  Random r(21);
  int sticks = 0, slips = 0, opens = 0;
  const int cases = count(400);
  for (int c = 0; c < cases; ++c) {
    const MatX A = gram(r, 3, 5, false);
    VecX b(3);
    b << r.uniform(-1, 0.4), r.uniform(-1, 1), r.uniform(-1, 1);
    const LcpProblem p = one_group(A, b, r.uniform(0, 1));
    const auto all = all_of_one_group(p);
    CAPTURE(c);
    for (const char* name : {"baraff", "cone_newton", "cone_interior"}) {
      CAPTURE(name);
      const LcpSolution s = cone_solve(name, p);
      CHECK(s.report.solved() == !all.empty());
      double nearest = 1e300;
      for (const VecX& z : all)
        nearest = std::min(nearest, (z - s.z).norm() / (1e-300 + z.norm() + 1e-9));
      if (s.report.solved()) CHECK(nearest < 1e-6);
      if (s.z[0] == 0)
        ++opens;
      else if (std::hypot(s.w[1], s.w[2]) < 1e-9)
        ++sticks;
      else
        ++slips;
    }
  }
  if (cases >= 100) {
    CHECK(opens > cases / 10);
    CHECK(sticks > cases / 10);
    CHECK(slips > cases / 10);
  }
}

TEST_CASE("random cones: solved to rounding, by the solver that the report names") {
  Random r(22);
  int own = 0, total = 0, systems = 0;
  for (int c = 0; c < count(600); ++c) {
    const auto shape = c % 2 ? ConeShape::pyramid : ConeShape::circular;
    const auto mode = c % 5 == 4 ? ConeMode::sliding : ConeMode::undecided;
    const bool definite_matrix = c % 3 == 0;
    // With sliding groups even a problem in the range need have no solution: only gentle slopes.
    const double steepest = mode == ConeMode::sliding ? 0.1 : 1.0;
    const LcpProblem p = make_cones(r, 1 + int(r.below(8)), definite_matrix, !definite_matrix,
                                    shape, mode, steepest);
    CAPTURE(c);
    const LcpSolution b = cone_solve("baraff", p), k = cone_solve("cone_newton", p);
    if (mode == ConeMode::undecided || definite_matrix) {
      CHECK(b.report.solved());
      CHECK(k.report.solved());
      CHECK(k.report.residual < 1e-10);
    }
    CHECK(b.report.solved() == k.report.solved());
    const LcpSolution path = cone_solve("cone_interior", p);
    CHECK(path.report.solved() == k.report.solved());
    systems += path.report.iterations;
    ++total;
    own += b.report.solver == "baraff";
    CHECK((b.report.solver == "baraff" || b.report.solver == "cone_newton" ||
           (mode == ConeMode::sliding && b.report.solver == "lemke")));
  }
  CHECK(own > total * 8 / 10);
  CHECK(systems < 20 * total);
}

TEST_CASE("Painleve's rod: inconsistent sliding is refuted, with a ray, and the rest is solved") {
  // A rod of mass 1 and half-length 1 that slides on its lower end at angle t: unit inertia 1/3, so
  // A_nn = 1 + 3 cos^2 t, A_nt = 3 sin t cos t; b_n = spin^2 sin t - g.
  int refuted = 0, solved = 0, free_flight = 0, lost = 0;
  const int apart = test::only_to_run() ? 6 : 1;  // of one angle and the next
  for (int k = 1; k < 60; k += apart) {
    const double t = 1.5 * k / 60, c = std::cos(t), s = std::sin(t);
    for (const double mu : {0.3, 1.4, 2.0, 5.0}) {
      for (const double spin : {0.0, 2.0, 6.0}) {
        MatX A(3, 3);
        A << 1 + 3 * c * c, 3 * s * c, 0, 3 * s * c, 1 + 3 * s * s, 0, 0, 0, 1;
        VecX b(3);
        b << spin * spin * s - 9.81, spin * spin * c, 0;
        LcpProblem p = one_group(A, b, mu);
        p.groups[0].mode = ConeMode::sliding;
        p.groups[0].direction = {1, 0};
        const double stiffness = A(0, 0) - mu * A(0, 1);
        if (std::fabs(stiffness) < 1e-6) continue;
        const LcpSolution x = cone_solve("baraff", p), l = cone_solve("lemke", p);
        CAPTURE(t);
        CAPTURE(mu);
        CAPTURE(spin);
        if (b[0] >= 0) {
          ++free_flight;  // for negative stiffness another solution exists; the open one is taken
          CHECK(x.z.norm() == 0);
          CHECK(l.z.norm() == 0);
        } else if (stiffness > 0) {
          ++solved;
          const double axial = -b[0] / stiffness;
          CHECK((x.z - (VecX(3) << axial, -mu * axial, 0).finished()).norm() < 1e-10 * axial);
          CHECK((l.z - x.z).norm() < 1e-10 * axial);
        } else {
          ++refuted;
          CHECK(x.report.status == LcpStatus::infeasible);
          REQUIRE(x.ray.size() == 3);
          CHECK(x.ray[0] > 0);
          CHECK(x.ray[1] == doctest::Approx(-mu * x.ray[0]));
          CHECK(l.report.status == LcpStatus::ray);
          CHECK(!cone_solve("cone_newton", p).report.solved());
          CHECK(!cone_solve("cone_interior", p).report.solved());
        }
        // Not yet sliding, the same rod has an answer: it sticks or slips, either way.
        p.groups[0].mode = ConeMode::undecided;
        CHECK(cone_solve("baraff", p).report.solved());
        CHECK(cone_solve("cone_newton", p).report.solved());
        lost += !cone_solve("cone_interior", p).report.solved();
      }
    }
  }
  // With friction as steep as 5 there may be several answers, and a path that turns back.
  CHECK(lost <= 2);
  CHECK(refuted > 50 / apart);
  CHECK(solved > 100 / apart);
  CHECK(free_flight > 50 / apart);
}

TEST_CASE("groups beside bounded and free unknowns") {
  Random r(23);
  for (int c = 0; c < count(200); ++c) {
    const int k = 1 + int(r.below(4)), extra = 1 + int(r.below(5)), n = 3 * k + extra;
    LcpProblem p = make_cones(r, k, true, false, c % 2 ? ConeShape::pyramid : ConeShape::circular,
                              ConeMode::undecided, 0.8);
    LcpProblem whole = LcpProblem::plain(gram(r, n, n + 2, false), VecX(n));
    for (int i = 0; i < n; ++i) {
      whole.b[i] = draw(r, false);
      whole.lower[i] = i < 3 * k ? p.lower[i] : i % 2 ? -inf : -0.1;
      if (i >= 3 * k && i % 4 == 0) whole.upper[i] = 0.2;
    }
    whole.groups = p.groups;
    CAPTURE(c);
    const LcpSolution b = cone_solve("baraff", whole), s = cone_solve("cone_newton", whole);
    CHECK(b.report.solved());
    CHECK(s.report.solved());
    CHECK(cone_solve("cone_interior", whole).report.solved());
  }
}

TEST_CASE(
    "a column of boxes with cones at rest: each layer carries what is above, no lateral part is "
    "needed") {
  for (const int layers : {1, 2, 5, 12}) {
    const LcpProblem p = boxes_with_cones(layers, 0.5);
    for (const char* name : {"baraff", "cone_newton", "cone_interior"}) {
      const LcpSolution s = cone_solve(name, p);
      CAPTURE(name);
      CAPTURE(layers);
      CHECK(s.report.solved());
      CHECK(s.report.solver == name);  // baraff went round in circles here where cones open from 0
      CHECK(s.report.residual < 1e-12);
      for (int k = 0; k < layers; ++k) {
        double carried = 0, sideways[2] = {0, 0};
        for (int c = 0; c < 4; ++c) {
          carried += s.z[12 * k + 3 * c];
          for (int t = 0; t < 2; ++t) sideways[t] += s.z[12 * k + 3 * c + 1 + t];
        }
        CHECK(std::fabs(carried - 9.81 * (layers - k)) < 1e-10 * layers);
        CHECK(std::fabs(sideways[0]) + std::fabs(sideways[1]) < 1e-10 * layers);
      }
    }
  }
}

TEST_CASE(
    "pushed and turned tables: nearly all slip directions converge from where pivoting ends") {
  // Directions that turned one by one, not together, went to and fro between two states here.
  Random r(24);
  int own = 0;
  const int cases = count(400);
  for (int c = 0; c < cases; ++c) {
    const double slope = r.uniform(0, 1), fx = r.uniform(-8, 8), fz = r.uniform(-8, 8);
    const double tx = r.uniform(-2, 2), ty = r.uniform(-4, 4), tz = r.uniform(-2, 2);
    const LcpProblem p =
        body_on_points({{-1, -0.5, -1}, {1, -0.5, -1}, {-1, -0.5, 1}, {1, -0.5, 1}},
                       {0.5, 0.7, 0.6}, {fx, -9.81, fz}, {tx, ty, tz}, slope);
    CAPTURE(c);
    const LcpSolution b = cone_solve("baraff", p), s = cone_solve("cone_newton", p);
    CHECK(b.report.solved());
    CHECK(s.report.solved());
    own += b.report.solver == "baraff";
  }
  CHECK(own >= cases * 9 / 10);
}

TEST_CASE("Newton with cones starts from a given z, which must be finite and of the right size") {
  Random r(25);
  for (int c = 0; c < count(100); ++c) {
    const LcpProblem p =
        make_cones(r, 4, true, false, ConeShape::circular, ConeMode::undecided, 0.5);
    const LcpSolution cold = cone_solve("cone_newton", p);
    REQUIRE(cold.report.solved());
    const auto warm = cone_newton_from(p, {}, cold.z);
    CHECK(warm->report.solved());
    CHECK(warm->report.iterations <= cold.report.iterations + 2);
    CHECK((warm->z - cold.z).norm() < 1e-6 * (1 + cold.z.norm()));
  }
  const LcpProblem p = boxes_with_cones(1, 0.5);
  CHECK(!cone_newton_from(p, {}, VecX::Zero(3)).ok());
  CHECK(!cone_newton_from(p, {}, VecX::Constant(12, inf)).ok());
}
