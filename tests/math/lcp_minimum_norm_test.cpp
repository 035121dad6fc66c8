// The solution of least norm. References: closed forms (a table on four legs), the variational
// inequality z (y - z) >= 0 with every other solution y, and independence of the solution started
// from.
#include "engine/math/lcp/least/minimum_norm.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/pivoting/lemke.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/lcp_families.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;
using namespace tumble::lcp_families;

namespace {

LcpProblem four_legs(std::array<double, 3> force, std::array<double, 3> torque, double slope) {
  return body_on_points({{-1, -1, -1}, {1, -1, -1}, {-1, -1, 1}, {1, -1, 1}}, {2, 3, 4}, force,
                        torque, slope);
}

}  // namespace

TEST_CASE("a table on four legs carries a quarter on each, and shares what pushes it") {
  for (const double slope : {0.0, 0.3, 0.8}) {
    const LcpProblem p = four_legs({0, -9.81, 0}, {0, 0, 0}, slope);
    const auto s = cone_newton(p);
    REQUIRE(s->report.solved());
    const auto m = minimum_norm(p, *s);
    REQUIRE(m->report.solved());
    for (int k = 0; k < 4; ++k) {
      CHECK(std::fabs(m->z[3 * k] - 9.81 / 4) < 1e-12);
      CHECK(std::fabs(m->z[3 * k + 1]) < 1e-12);
      CHECK(std::fabs(m->z[3 * k + 2]) < 1e-12);
    }
  }
  // Pushed sideways at its centre, 1 above the feet: the pairs of legs differ by F h / (2 * 2).
  const LcpProblem p = four_legs({2, -9.81, 0}, {0, 0, 0}, 0.5);
  const auto m = minimum_norm(p, *cone_newton(p));
  REQUIRE(m->report.solved());
  for (int k = 0; k < 4; ++k) {
    CHECK(std::fabs(m->z[3 * k] - (9.81 / 4 + (k % 2 ? 0.5 : -0.5))) < 1e-12);
    CHECK(std::fabs(m->z[3 * k + 1] + 0.5) < 1e-12);
    CHECK(std::fabs(m->z[3 * k + 2]) < 1e-12);
  }
}

TEST_CASE("a table loaded near one corner stands on three legs, without pull on the fourth") {
  // The load at (0.8, 0.7): the plane of least squares would pull at the corner (-1, -1) with
  // (1 - 0.8 - 0.7) / 4 of it. On three legs the moments fix every share.
  const double load = 9.81, x = 0.8, z = 0.7;
  LcpProblem p = four_legs({0, -load, 0}, {load * z, 0, -load * x}, 0);
  LcpProblem axial = LcpProblem::plain(MatX(4, 4), VecX(4));
  for (int i = 0; i < 4; ++i) {
    axial.b[i] = p.b[3 * i];
    for (int j = 0; j < 4; ++j) axial.A(i, j) = p.A(3 * i, 3 * j);
  }
  const auto m = minimum_norm(axial, *dantzig(axial));
  REQUIRE(m->report.solved());
  const double expected[4] = {0, (1 - z) / 2 * load, (1 - x) / 2 * load, (x + z) / 2 * load};
  for (int k = 0; k < 4; ++k) CHECK(std::fabs(m->z[k] - expected[k]) < 1e-12 * load);
}

TEST_CASE("the least norm depends on the problem only") {
  Random r(31);
  int redundant = 0, cases = count(600);
  for (int c = 0; c < cases; ++c) {
    const auto family = Family(1 + c % 5);
    const LcpProblem p = make(r, 2 + int(r.below(14)), family);
    const auto first = dantzig(p), second = lemke(p);
    if (!first->report.solved() || !second->report.solved()) continue;
    CAPTURE(c);
    const auto a = minimum_norm(p, *first), b = minimum_norm(p, *second);
    REQUIRE(a->report.solved());
    REQUIRE(b->report.solved());
    const double unit = a->z.norm() + 1e-300;
    CHECK((a->z - b->z).norm() < 1e-8 * unit);
    for (const VecX& y : {first->z, second->z}) {
      CHECK(a->z.norm() <= y.norm() * (1 + 1e-9));
      CHECK(a->z.dot(y - a->z) >= -1e-8 * unit * unit);
    }
    redundant += (a->z - first->z).norm() > 1e-6 * unit;
  }
  if (cases >= 100) CHECK(redundant > cases / 10);
}

TEST_CASE("cones are kept where the norm is lessened") {
  Random r(32);
  for (int c = 0; c < count(300); ++c) {
    const LcpProblem p =
        make_cones(r, 1 + int(r.below(5)), false, true,
                   c % 2 ? ConeShape::pyramid : ConeShape::circular, ConeMode::undecided, 1.0);
    const auto s = cone_newton(p);
    CAPTURE(c);
    REQUIRE(s->report.solved());
    const auto m = minimum_norm(p, *s);
    REQUIRE(m->report.solved());
    CHECK(validate(p, m->z).worst() < 1e-9);
    CHECK(m->z.norm() <= s->z.norm() * (1 + 1e-7));
    CHECK(m->z.dot(s->z - m->z) >= -1e-7 * m->z.squaredNorm());
  }
}

TEST_CASE("what is not solved comes back as it was, hostile solutions are refused") {
  const LcpProblem p = LcpProblem::plain(MatX::Identity(2, 2), VecX::Constant(2, -1));
  LcpSolution s;
  s.z = VecX::Zero(3);
  CHECK(!minimum_norm(p, s).ok());
  s.z = VecX::Constant(2, std::nan(""));
  CHECK(!minimum_norm(p, s).ok());
  s.z = VecX::Zero(2);
  s.report.status = LcpStatus::infeasible;
  CHECK(minimum_norm(p, s)->report.status == LcpStatus::infeasible);
}
