// Input that no LCP solver can use is refused with an Error that says what is wrong.
#include "engine/math/lcp/solvers.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/lcp_families.hpp"

#include <functional>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::lcp;
using lcp_families::inf;

namespace {

LcpProblem sound(int n) {
  return LcpProblem::plain(MatX::Identity(n, n), VecX::Constant(n, -1));
}

LcpProblem with_group() {
  LcpProblem p = sound(3);
  p.lower[1] = p.lower[2] = -inf;
  p.groups.push_back({0, {1, 2}, 0.5, ConeMode::undecided, ConeShape::circular, {}});
  return p;
}

}  // namespace

TEST_CASE("hostile LCPs are refused by every solver") {
  const double nan = std::nan("");
  struct Case {
    const char* words;
    std::function<void(LcpProblem&)> spoil;
  };
  const Case cases[] = {
      {"A is 2 x 3",
       [](LcpProblem& p) {
         p.A.resize(2, 3);
         p.A.setZero();
       }},
      {"lower and", [](LcpProblem& p) { p.lower.resize(1); }},
      {"column 1 of A", [&](LcpProblem& p) { p.A(2, 1) = nan; }},
      {"column 0 of A", [](LcpProblem& p) { p.A(0, 0) = inf; }},
      {"b[2]", [&](LcpProblem& p) { p.b[2] = nan; }},
      {"lower nan", [&](LcpProblem& p) { p.lower[0] = nan; }},
      {"lower 2 is not <= upper 1", [](LcpProblem& p) { p.lower[1] = 2, p.upper[1] = 1; }},
      {"leave nothing", [](LcpProblem& p) { p.lower[1] = inf; }},
      {"leave nothing", [](LcpProblem& p) { p.lower[1] = p.upper[1] = -inf; }},
      {"names unknown 7",
       [](LcpProblem& p) {
         p.groups.push_back({0, {1, 7}, 1, {}, {}, {}});
       }},
      {"names unknown -1",
       [](LcpProblem& p) {
         p.groups.push_back({-1, {1, 2}, 1, {}, {}, {}});
       }},
      {"two places",
       [](LcpProblem& p) {
         p.groups.push_back({0, {1, 1}, 1, {}, {}, {}});
       }},
      {"must have no bounds",
       [](LcpProblem& p) {
         p.groups.push_back({0, {1, 2}, 1, {}, {}, {}});
       }},
      {"bounds 0 and infinity",
       [](LcpProblem& p) {
         p = with_group();
         p.upper[0] = 3;
       }},
      {"slope",
       [&](LcpProblem& p) {
         p = with_group();
         p.groups[0].slope = nan;
       }},
      {"slope",
       [](LcpProblem& p) {
         p = with_group();
         p.groups[0].slope = -1;
       }},
      {"has length",
       [](LcpProblem& p) {
         p = with_group();
         p.groups[0].mode = ConeMode::sliding;
         p.groups[0].direction = {0.5, 0.5};
       }},
  };
  for (const Case& c : cases) {
    LcpProblem p = sound(3);
    c.spoil(p);
    for (const LcpSolverEntry& e : all_lcp_solvers()) {
      const auto s = e.solve(p, {});
      CAPTURE(c.words);
      CAPTURE(e.name);
      REQUIRE(!s.ok());
      CHECK(s.error().code == ErrorCode::invalid_argument);
      CHECK_MESSAGE(s.error().message.find(c.words) != std::string::npos, s.error().message);
    }
  }
}

TEST_CASE("LCP solvers refuse what they cannot do, and solve nothing at all") {
  LcpProblem skew = sound(2);
  skew.A(0, 1) = 1;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    CAPTURE(e.name);
    CHECK(e.solve(skew, {}).ok() == e.unsymmetric);
    CHECK(e.solve(with_group(), {}).ok() == e.undecided);
    LcpProblem slides = with_group();
    slides.groups[0].mode = ConeMode::sliding;
    slides.groups[0].direction = {0, 1};
    CHECK(e.solve(slides, {}).ok() == e.sliding);
    const auto empty = e.solve(LcpProblem::plain(MatX(0, 0), VecX(0)), {});
    REQUIRE(empty.ok());
    CHECK(empty->report.status == LcpStatus::solved);
    CHECK(empty->report.residual == 0);
  }
}

TEST_CASE("zero matrices, zero rows, fixed unknowns and huge numbers") {
  LcpProblem p = LcpProblem::plain(MatX::Zero(3, 3), VecX::Constant(3, 1));
  p.b[1] = 0;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    CAPTURE(e.name);
    CHECK(e.solve(p, {})->report.solved());
  }
  p.b[2] = -1;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    CAPTURE(e.name);
    const auto s = e.solve(p, {});
    CHECK(!s->report.solved());
    if (e.proves) CHECK(s->report.status == LcpStatus::infeasible);
  }
  p.upper[2] = 4;
  CHECK(all_lcp_solvers().front().solve(p, {})->z[2] == 4);
  p = sound(3);
  p.lower[0] = p.upper[0] = -2;
  p.A(0, 1) = p.A(1, 0) = 0.5;
  for (const LcpSolverEntry& e : all_lcp_solvers()) {
    CAPTURE(e.name);
    const auto s = e.solve(p, {});
    CHECK(s->report.solved());
    CHECK(s->z[0] == -2);
    CHECK(s->z[1] == doctest::Approx(2));
  }
  for (const double f : {1e-200, 1e200, 1e300}) {
    p = sound(3);
    p.A *= f;
    const auto s = all_lcp_solvers().front().solve(p, {});
    CHECK(s->report.solved());
    CHECK(s->z[0] == doctest::Approx(1 / f));
  }
}
