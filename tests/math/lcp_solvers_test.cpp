// Linear complementarity with bounds. References: enumeration of all assignments (up to 8
// unknowns), the validator, which computes w = A z + b from z alone, the certificate of
// infeasibility, and for semi-definite matrices the uniqueness of w.
#include "engine/core/hash.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/math/lcp/solvers.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/lcp_families.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/why_not.hpp"

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;
using namespace tumble::lcp_families;

namespace {

const LcpSolverEntry& lcp_solver(std::string_view name) {
  for (const LcpSolverEntry& e : all_lcp_solvers())
    if (e.name == name) return e;
  FAIL("no such solver");
  return all_lcp_solvers().front();
}

LcpSolution lcp_solve(std::string_view name, const LcpProblem& p, LcpOptions options = {}) {
  auto s = lcp_solver(name).solve(p, options);
  REQUIRE_MESSAGE(s.ok(), test::why_not(s));
  CHECK(s->report.solver == name);
  CHECK(s->z.size() == p.size());
  CHECK(s->report.residual == validate(p, s->z).worst());
  return std::move(*s);
}

/// The greatest difference of two w, in units in which the diagonal of A and the terms are 1.
double w_difference(const LcpProblem& p, const LcpSolution& a, const LcpSolution& b) {
  double most = 0, unit = 1e-300;
  for (int i = 0; i < p.size(); ++i) {
    const double d = p.A(i, i) > 0 ? 1 / std::sqrt(p.A(i, i)) : 1;
    most = std::max(most, std::fabs(a.w[i] - b.w[i]) * d);
    unit = std::max({unit, std::fabs(p.b[i]) * d, std::fabs(a.z[i]) / d});
  }
  return most / unit;
}

}  // namespace

TEST_CASE("every LCP solver agrees with enumeration on random and degenerate problems") {
  Random r(11);
  int solved = 0, infeasible = 0, cases = count(3000);
  for (int c = 0; c < cases; ++c) {
    const auto family = Family(c % 6);
    const int n = 1 + int(r.below(8));
    LcpProblem p = make(r, n, family);
    if (c % 4 == 3) rescale(r, p, 4);
    CAPTURE(c);
    CAPTURE(family_names[family]);
    const LcpSolution reference = lcp_solve("enumeration", p);
    const LcpStatus expected = reference.report.status;
    REQUIRE((expected == LcpStatus::solved || expected == LcpStatus::infeasible));
    (expected == LcpStatus::solved ? solved : infeasible)++;
    for (const LcpSolverEntry& e : all_lcp_solvers()) {
      CAPTURE(e.name);
      LcpOptions options;
      if (e.name == "pgs") options.tolerance = 1e-5;
      const LcpSolution s = lcp_solve(e.name, p, options);
      if (expected == LcpStatus::infeasible) {
        CHECK(!s.report.solved());
        if (e.proves) CHECK((s.report.status == expected || e.name == "lemke"));
        if (s.ray.size() > 0 && s.report.status == expected) CHECK(ray_residual(p, s.ray) < 1e-9);
      } else if (e.proves && e.name != "lemke") {
        CHECK(s.report.status == LcpStatus::solved);
        CHECK(s.report.residual < 1e-12);
        CHECK(s.report.complementarity < 1e-12);
        CHECK(w_difference(p, s, reference) < 1e-10);
      } else if (s.report.solved()) {
        CHECK(w_difference(p, s, reference) < (e.name == "pgs" ? 1e-2 : 1e-7));
      } else {
        // Sweeps may be slow; lemke splits free unknowns, which strains its ratio test.
        CHECK((e.name == "pgs" || e.name == "cone_newton" || e.name == "cone_interior" ||
               e.name == "lemke"));
      }
    }
  }
  CHECK(solved > cases / 2);
  CHECK(infeasible > cases / 20);
}

TEST_CASE("dantzig pays for clamping all at once, and is stopped between two unknowns") {
  // A triangular solution for each of n unknowns that all end up clamped: n^3 / 6 multiplications.
  Random r(21);
  constexpr int n = 300;
  MatX factor(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) factor(i, j) = r.uniform(0, 1);
  const MatX A = factor * factor.transpose() + n * MatX::Identity(n, n);
  VecX z(n);
  for (int i = 0; i < n; ++i) z[i] = 1 + r.uniform(0, 1);
  const LcpProblem p = LcpProblem::plain(A, -(A * z));
  WorkMeter meter;
  {
    const Metered metered(meter);
    CHECK((lcp_solve("dantzig", p).z - z).norm() < 1e-9 * z.norm());
  }
  CHECK(meter.spent() > uint64_t(n) * n * n / 6);
  CHECK(meter.spent() < uint64_t(n) * n * n);

  StopFlag flag;
  const Stoppable stoppable(&flag);
  constexpr int64_t plenty = int64_t{1} << 40;
  flag.request_after(plenty);
  lcp_solve("dantzig", p);
  const int64_t looks = plenty - flag.looks_left();
  CHECK(looks > n);
  for (int k = 0; k < 10; ++k) {
    flag.request_after(looks * k / 10);
    CHECK_FALSE(lcp_solve("dantzig", p).report.solved());
    CHECK(-flag.looks_left() < 20);
  }
}

TEST_CASE("dantzig solves or refutes larger problems, and lemke and Newton agree") {
  Random r(12);
  for (int c = 0; c < count(60); ++c) {
    const auto family = Family(c % 6);
    LcpProblem p = make(r, 20 + int(r.below(60)), family);
    if (c % 2) rescale(r, p, 4);
    CAPTURE(c);
    const LcpSolution s = lcp_solve("dantzig", p);
    if (s.report.status == LcpStatus::infeasible) {
      CHECK(ray_residual(p, s.ray) < 1e-9);
      CHECK(!lcp_solve("lemke", p).report.solved());
      continue;
    }
    CHECK(s.report.status == LcpStatus::solved);
    CHECK(s.report.residual < 1e-12);
    const LcpSolution l = lcp_solve("lemke", p), k = lcp_solve("cone_newton", p);
    if (l.report.solved()) CHECK(w_difference(p, s, l) < 1e-8);
    if (k.report.solved()) CHECK(w_difference(p, s, k) < 1e-8);
    CHECK(l.report.status != LcpStatus::infeasible);
  }
}

TEST_CASE(
    "rows that nearly depend on others: dantzig solves what has a solution, and proves nothing "
    "false") {
  // Small pivots of the size of rounding once looked like a matrix that is not semi-definite, and
  // noise along a null vector like a proof of infeasibility.
  Random r(15);
  for (int c = 0; c < count(2000); ++c) {
    const bool in_range = c % 2 == 0;
    const double apart = std::pow(10.0, -r.uniform(1, 15));
    LcpProblem p = make_near_singular(r, 2 + int(r.below(c % 10 == 0 ? 50 : 8)), apart, in_range);
    if (c % 3 == 0) rescale(r, p, c % 4 == 0 ? 8 : 3);
    CAPTURE(c);
    CAPTURE(apart);
    const LcpSolution s = lcp_solve("dantzig", p);
    if (in_range) CHECK(s.report.status == LcpStatus::solved);
    if (s.report.solved()) CHECK(s.report.residual < 1e-9);
    if (s.report.status == LcpStatus::infeasible) CHECK(ray_residual(p, s.ray) < 1e-9);
    CHECK(s.report.status != LcpStatus::cycling);
  }
}

TEST_CASE("five hundred unknowns, definite and not") {
  Random r(13);
  const int n = test::scale_is_set() ? std::max(60, count(500)) : 500;
  for (const Family family : {definite, consistent, mixed}) {
    LcpProblem p = make(r, std::min(n, 500), family);
    if (family == mixed) p.b = times(p.A, p.b);
    const LcpSolution s = lcp_solve("dantzig", p);
    CHECK(s.report.status == LcpStatus::solved);
    CHECK(s.report.residual < 1e-12);
  }
}

TEST_CASE("a column of boxes with four axial unknowns per layer is solved without regularisation") {
  for (const int layers : {1, 2, 5, 12, 50, 125}) {
    const LcpProblem p = column_of_boxes(layers);
    const LcpSolution s = lcp_solve("dantzig", p);
    CAPTURE(layers);
    CHECK(s.report.status == LcpStatus::solved);
    CHECK(s.report.residual < 1e-12);
    for (int k = 0; k < layers; ++k) {
      const double carried = s.z[4 * k] + s.z[4 * k + 1] + s.z[4 * k + 2] + s.z[4 * k + 3];
      CHECK(std::fabs(carried - 9.81 * (layers - k)) < 1e-12 * 9.81 * layers);
    }
  }
}

TEST_CASE("LCP answers have the same bits in every run and for every compiler") {
  Random r(14);
  uint64_t hash = 0;
  for (int c = 0; c < 24; ++c) {
    const LcpProblem p = make(r, 10 + c, Family(c % 6));
    for (const char* name : {"dantzig", "lemke", "cone_newton"}) {
      const LcpSolution s = lcp_solve(name, p), t = lcp_solve(name, p);
      REQUIRE(s.z == t.z);
      hash = hash_bytes(s.z.data(), sizeof(double) * size_t(s.z.size()), hash);
    }
  }
  for (int c = 0; c < 12; ++c) {
    const LcpProblem p =
        make_cones(r, 1 + c % 5, c % 2 == 0, c % 2 == 1,
                   c % 3 ? ConeShape::circular : ConeShape::pyramid, ConeMode::undecided, 0.7);
    for (const char* name : {"baraff", "cone_newton", "pgs"}) {
      const auto s = lcp_solver(name).solve(p, {});
      hash = hash_bytes(s->z.data(), sizeof(double) * size_t(s->z.size()), hash);
    }
  }
  // A solver that takes other steps changes this; a compiler or a machine must not.
  CHECK(hash_text(hash) == "e1f88b9dceb1b15d");
}
