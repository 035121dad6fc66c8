// Published linear complementarity problems whose solutions are known in closed form.
#include "engine/math/lcp/solvers.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/lcp_families.hpp"

#include <algorithm>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;

namespace {

/// All solvers that take the matrix find `expected`, to `tolerance`; those that give up say so.
void expect_answer(const LcpProblem& p, const VecX& expected, double tolerance = 1e-11) {
  REQUIRE(validate(p, expected).worst() < 1e-15);
  const bool symmetric = check_symmetric(p).ok();
  int answers = 0;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    CAPTURE(e.name);
    if (!symmetric && !e.unsymmetric) {
      CHECK(!e.solve(p, {}).ok());
      continue;
    }
    if (e.name == "enumeration" && p.size() > 12) continue;
    const auto s = e.solve(p, {});
    REQUIRE(s.ok());
    if (!s->report.solved()) {
      CHECK((e.name == "pgs" || e.name == "cone_newton" || e.name == "cone_interior"));
      continue;
    }
    ++answers;
    const double unit = std::max(1e-300, expected.cwiseAbs().maxCoeff());
    CHECK((s->z - expected).cwiseAbs().maxCoeff() / unit < (e.name == "pgs" ? 1e-5 : tolerance));
  }
  CHECK(answers >= (symmetric || p.size() <= 12 ? 2 : 1));
}

}  // namespace

TEST_CASE("Murty's problems, on which complementary pivoting visits 2^n bases") {
  // Murty 1978: ones on the diagonal, twos below; q_i = -(2^n + ... + 2^(n+1-i)): z = (2^n, 0 ...).
  for (const int n : {2, 4, 8, 10}) {
    MatX A = MatX::Identity(n, n);
    VecX b(n), z = VecX::Zero(n);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < i; ++j) A(i, j) = 2;
      sum += std::ldexp(1.0, n - i);
      b[i] = -sum;
    }
    z[0] = std::ldexp(1.0, n);
    expect_answer(LcpProblem::plain(A, b), z);
  }
  // The other triangle with q = -1: z = (0 ... 0, 1).
  for (const int n : {3, 12, 40}) {
    MatX A = MatX::Identity(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = i + 1; j < n; ++j) A(i, j) = 2;
    VecX z = VecX::Zero(n);
    z[n - 1] = 1;
    expect_answer(LcpProblem::plain(A, VecX::Constant(n, -1)), z);
  }
}

TEST_CASE(
    "Fathi's matrices: definite, ill-conditioned, exponential for Murty's and Lemke's methods") {
  for (const int n : {2, 5, 12, 50, 200}) {
    MatX A(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) A(i, j) = i == j ? 1 + 4 * i : 2 + 4 * std::min(i, j);
    VecX z = VecX::Zero(n);
    z[0] = 1;
    expect_answer(LcpProblem::plain(A, VecX::Constant(n, -1)), z);
  }
}

TEST_CASE("Kostreva's example, on which Bard's method without a rule cycles") {
  MatX A(3, 3);
  A << 1, 2, 0, 0, 1, 2, 2, 0, 1;
  expect_answer(LcpProblem::plain(A, VecX::Constant(3, -1)), VecX::Constant(3, 1.0 / 3));
}

TEST_CASE("a linear program as a complementarity problem") {
  // Max 3 x + 5 y with x <= 4, 2 y <= 12, 3 x + 2 y <= 18: x = 2, y = 6, prices 0, 3/2, 1.
  MatX A = MatX::Zero(5, 5);
  const double G[3][2] = {{1, 0}, {0, 2}, {3, 2}};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 2; ++j) {
      A(j, 2 + i) = G[i][j];
      A(2 + i, j) = -G[i][j];
    }
  VecX b(5), z(5);
  b << -3, -5, 4, 12, 18;
  z << 2, 6, 0, 1.5, 1;
  expect_answer(LcpProblem::plain(A, b), z);
}

TEST_CASE("a string over an obstacle: second differences with an obstacle from below") {
  // -u'' = -8 on (0, 1), u(0) = u(1) = 0, u >= -1/4, n points. By hand: the free part from 0 to the
  // first touching point a is the parabola 4 x^2 - s x with u(a) = -1/4 and u'(a) = 0: a = 1/4. The
  // grid has x = 1/4 as a point, and second differences of a parabola are exact.
  for (const int n : {7, 15, 127}) {
    const double h = 1.0 / (n + 1);
    MatX A = MatX::Zero(n, n);
    VecX z(n);
    for (int i = 0; i < n; ++i) {
      A(i, i) = 2;
      if (i > 0) A(i, i - 1) = A(i - 1, i) = -1;
      const double x = std::min((i + 1) * h, 1 - (i + 1) * h);
      z[i] = x < 0.25 ? 4 * x * x - 2 * x : -0.25;
    }
    LcpProblem p = LcpProblem::plain(A, VecX::Constant(n, 8 * h * h));
    p.lower.setConstant(-0.25);
    REQUIRE(validate(p, z).worst() < 1e-14);
    for (const char* name : {"dantzig", "lemke", "cone_newton"}) {
      for (const LcpSolverEntry& e : all_lcp_solvers()) {
        if (e.name != name) continue;
        const auto s = e.solve(p, {});
        CAPTURE(name);
        CHECK(s->report.solved());
        CHECK((s->z - z).cwiseAbs().maxCoeff() < 1e-10);
      }
    }
  }
}

TEST_CASE("matrices that are not semi-definite end with a defined status") {
  MatX A(2, 2);
  A << 1, 2, 2, 1;  // w = A z - 1: solutions (1, 0), (0, 1) and (1/3, 1/3)
  const LcpProblem p = LcpProblem::plain(A, VecX::Constant(2, -1));
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    const auto s = e.solve(p, {});
    CAPTURE(e.name);
    CHECK(
        (s->report.status == LcpStatus::solved || s->report.status == LcpStatus::not_semidefinite));
  }
  A << -1, 0, 0, -1;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    const auto s = e.solve(LcpProblem::plain(A, VecX::Constant(2, -1)), {});
    CAPTURE(e.name);
    CHECK(!s->report.solved());
  }
  A << 0, 1, 1, 0;  // indefinite with zero diagonal: z = (1, 1)
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    const auto s = e.solve(LcpProblem::plain(A, VecX::Constant(2, -1)), {});
    CAPTURE(e.name);
    if (e.name == "dantzig") CHECK(s->report.status == LcpStatus::not_semidefinite);
    if (e.name == "enumeration") CHECK(s->report.solved());
  }
}
