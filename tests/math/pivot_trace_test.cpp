// The steps of Dantzig's and Baraff's pivots. References: w = A z + b computed from z alone, the
// conditions by their definition, enumeration of all assignments, the difference of two steps.
#include "engine/math/lcp/pivoting/baraff.hpp"
#include "engine/math/lcp/pivoting/dantzig.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/lcp_families.hpp"
#include "tests/support/scale.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;

namespace {

double number(uint64_t& seed) {
  seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
  return double(seed >> 11) * 0x1p-52 - 1;
}

/// Definite, with bounds 0 and infinity.
LcpProblem definite(int n, uint64_t seed) {
  MatX G(n, n);
  VecX b(n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) G(i, j) = number(seed);
    b[i] = number(seed);
  }
  MatX A = G * G.transpose();
  for (int i = 0; i < n; ++i) A(i, i) += 0.1;
  return LcpProblem::plain(std::move(A), std::move(b));
}

/// What each step claims of its sets.
void check_sets(const LcpProblem& p, const PivotTrace& trace) {
  for (const PivotStep& s : trace.steps) {
    const VecX w = slack(p, s.z);
    REQUIRE(s.sets.size() == size_t(p.size()));
    for (int i = 0; i < p.size(); ++i) {
      // Laterals are along axes that the method turns.
      const bool lateral = !p.groups.empty() && i % 3 != 0;
      if (s.sets[size_t(i)] == PivotSet::clamped && !lateral) CHECK(std::fabs(w[i]) < 1e-9);
      if (s.sets[size_t(i)] == PivotSet::at_lower && p.groups.empty()) CHECK(s.z[i] == p.lower[i]);
    }
  }
}

}  // namespace

TEST_CASE("Dantzig's steps lead from 0 to the solution, each by what it says") {
  int pivots = 0, stopped = 0;
  for (int k = 0; k < test::scaled_count(60); ++k) {
    const LcpProblem p = definite(2 + k % 6, uint64_t(k) + 11);
    PivotTrace trace;
    const auto solved = watch_dantzig(p, trace);
    const auto plain = dantzig(p), reference = enumeration(p);
    REQUIRE((solved.ok() && plain.ok() && reference.ok()));
    REQUIRE(solved->report.solved());
    CHECK(solved->report.iterations >= int(trace.steps.size()) - 1);
    CHECK((solved->z - reference->z).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((plain->z - reference->z).cwiseAbs().maxCoeff() < 1e-9);
    CHECK((trace.steps.back().z - reference->z).cwiseAbs().maxCoeff() < 1e-9);
    CHECK(trace.steps.front().driven == -1);
    CHECK(trace.steps.front().z.isZero(0));
    check_sets(p, trace);
    for (size_t i = 1; i < trace.steps.size(); ++i) {
      const PivotStep &a = trace.steps[i - 1], &b = trace.steps[i];
      REQUIRE(b.driven >= 0);
      CHECK(b.z[b.driven] - a.z[b.driven] == doctest::Approx(b.step).epsilon(1e-9));
      CHECK(b.event != PivotEvent::none);
      ++pivots;
      if (b.event == PivotEvent::own_w)
        CHECK(b.sets[size_t(b.driven)] == PivotSet::clamped);
      else
        ++stopped;
      // What was right stays right: that is why a drive stops.
      const VecX before = slack(p, a.z), after = slack(p, b.z);
      for (int j = 0; j < p.size(); ++j) {
        CHECK(b.z[j] > -1e-9);
        if (j != b.driven && before[j] > -1e-12) CHECK(after[j] > -1e-9);
      }
    }
  }
  if (test::scaled_count(60) >= 60) CHECK((pivots > 100 && stopped > 10));
}

TEST_CASE("Baraff's last step is the answer but for the directions of friction") {
  int solved_by_pivots = 0;
  for (int k = 0; k < test::scaled_count(40); ++k) {
    uint64_t seed = uint64_t(k) + 5;
    LcpProblem p = definite(6, seed);
    p.b[0] -= 2, p.b[3] -= 2;
    p.lower = VecX::Constant(6, -std::numeric_limits<double>::infinity());
    p.lower[0] = p.lower[3] = 0;
    p.add_group(0, 0.4), p.add_group(3, 0.7);
    PivotTrace trace;
    const auto solved = watch_baraff(p, trace);
    const auto plain = baraff(p);
    REQUIRE((solved.ok() && plain.ok()));
    CHECK(solved->z == plain->z);
    CHECK(solved->report.solver == plain->report.solver);
    check_sets(p, trace);
    for (const PivotStep& s : trace.steps)
      for (const ConeGroup& g : p.groups)
        CHECK(std::hypot(s.z[g.lateral[0]], s.z[g.lateral[1]]) <= g.slope * s.z[g.axial] + 1e-9);
    if (solved->report.solver != "baraff") continue;
    ++solved_by_pivots;
    CHECK(trace.polished);
    const VecX w = slack(p, trace.steps.back().z);
    CHECK(w[0] > -1e-9);
    CHECK(w[3] > -1e-9);
  }
  if (test::scaled_count(40) >= 40) CHECK(solved_by_pivots > 5);
}

TEST_CASE("a problem without a solution is watched to where nothing stops the drive") {
  MatX A(2, 2);
  A << 1, -1, -1, 1;
  VecX b(2);
  b << -1, -1;
  PivotTrace trace;
  const auto solved = watch_dantzig(LcpProblem::plain(A, b), trace);
  REQUIRE(solved.ok());
  CHECK(solved->report.status == LcpStatus::infeasible);
  CHECK(trace.steps.size() >= 1);
}
