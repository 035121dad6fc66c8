// Problems with cones that have no solution. References: for one group and bounds, a search over
// all ways in which the group can be (open, holding, slipping in any direction, by bisection) with
// all places of the others; the proof itself, multiplied out in long double; enumeration.
#include "engine/math/lcp/cones/solve_cones.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/validate.hpp"
#include "tests/math/block_matrix.hpp"
#include "tests/math/lcp_families.hpp"
#include "tests/support/dense.hpp"

#include <algorithm>
#include <string>

#include <doctest/doctest.h>

using namespace tumble;
using namespace tumble::test;
using namespace tumble::lcp;
using namespace tumble::lcp_families;

namespace {

/// Bodies on a line that press against each other between two walls, each contact with friction:
/// point k is between body k - 1 and body k, the walls are the ends. Masses are random, `closing`
/// is the speed at which the walls come together (less than 0: apart).
BlockProblem squeezed_row(Random& r, int bodies, double closing) {
  BlockProblem p;
  p.blocks = bodies;
  LcpProblem& c = p.conditions;
  std::vector<double> speed(size_t(bodies) + 2);
  speed.front() = 0;
  speed.back() = -closing;
  for (int k = 1; k <= bodies; ++k) speed[size_t(k)] = r.uniform(-1, 1);
  std::vector<double> root(size_t(bodies) + 2);
  for (double& x : root) x = r.uniform(0.3, 3);
  std::vector<double> b;
  for (int k = 0; k <= bodies; ++k) {
    c.add_group(3 * k, r.uniform(0.1, 1.5));
    for (int axis = 0; axis < 3; ++axis) {
      BlockRow row;
      row.block = {k > 0 ? k - 1 : -1, k < bodies ? k : -1};
      for (size_t s = 0; s < 2; ++s) {
        if (row.block[s] < 0) continue;
        const double sign = s == 0 ? -1 : 1;
        row.entries[s][size_t(axis)] = sign * root[size_t(row.block[s]) + 1];
        // Arms along the line: friction turns, the normal does not.
        if (axis == 1) row.entries[s][5] = r.uniform(0.2, 0.6);
        if (axis == 2) row.entries[s][4] = r.uniform(0.2, 0.6);
      }
      p.rows.push_back(row);
      b.push_back(axis == 0 ? speed[size_t(k) + 1] - speed[size_t(k)] : r.uniform(-1, 1));
    }
  }
  const auto n = Eigen::Index(b.size());
  c.b = Eigen::Map<const VecX>(b.data(), n);
  c.lower = VecX::Constant(n, -inf), c.upper = VecX::Constant(n, inf);
  for (const ConeGroup& g : c.groups) c.lower[g.axial] = 0;
  return p;
}

ConeTask task_of(const BlockProblem& p, bool by_blocks) {
  ConeTask task;
  task.problem = p.conditions;
  task.matrix = [&p] { return with_matrix(p).A; };
  if (by_blocks) task.blocks = p;
  return task;
}

/// The proof without the solver's arithmetic: d >= 0 in axial unknowns, 0 in lateral ones, any in
/// free ones, A d = 0, b d < 0.
bool proves(const LcpProblem& p, const VecX& d) {
  if (d.size() != p.size()) return false;
  std::vector<char> lateral(size_t(p.size()), 0);
  for (const ConeGroup& g : p.groups)
    for (const int i : g.lateral) lateral[size_t(i)] = 1;
  long double most = 0, gain = 0;
  for (int i = 0; i < p.size(); ++i) {
    most = std::max(most, std::fabs((long double)d[i]));
    gain += (long double)p.b[i] * (long double)d[i];
    if (lateral[size_t(i)] && d[i] != 0) return false;
    if (p.upper[i] < inf && d[i] > 0) return false;
    if (p.lower[i] > -inf && d[i] < 0 && -d[i] > 1e-12) return false;
  }
  for (int i = 0; i < p.size(); ++i) {
    long double sum = 0, terms = 0;
    for (int j = 0; j < p.size(); ++j) {
      sum += (long double)p.A(i, j) * (long double)d[j];
      terms += std::fabs((long double)p.A(i, j) * (long double)d[j]);
    }
    if (std::fabs(sum) > 1e-9L * std::max(terms, 1e-300L)) return false;
  }
  return most > 0 && gain < 0;
}

/// Whether any z of one group solves: it is open, or holds, or slips along one of many directions
/// with the residual that bisection leaves.
bool one_group_has_solution(const LcpProblem& p) {
  const double mu = p.groups[0].slope, unit = p.b.cwiseAbs().maxCoeff();
  if (p.b[0] >= 0) return true;
  const MatX& A = p.A;
  constexpr int parts = 4000;
  const auto slip = [&](double angle, double& across, double& along) {
    const double c = std::cos(angle), s = std::sin(angle);
    VecX z(3);
    const double stiffness = A(0, 0) + mu * (c * A(0, 1) + s * A(0, 2));
    if (!(stiffness > 1e-12)) return false;
    const double axial = -p.b[0] / stiffness;
    z << axial, mu * axial * c, mu * axial * s;
    const VecX w = A * z + p.b;
    across = c * w[2] - s * w[1], along = c * w[1] + s * w[2];
    return true;
  };
  for (int k = 0; k < parts; ++k) {
    double lo = 6.283185307179586 * k / parts, hi = 6.283185307179586 * (k + 1) / parts;
    double x, y, along;
    if (!slip(lo, x, along) || !slip(hi, y, along) || x * y > 0) continue;
    for (int i = 0; i < 60; ++i) {
      const double mid = 0.5 * (lo + hi);
      double m;
      if (!slip(mid, m, along)) break;
      (m * x > 0 ? lo : hi) = mid;
    }
    if (along <= 1e-9 * unit) return true;
  }
  // Holding: least squares, which is exact where the three rows can be equations.
  const VecX z = solve_symmetric(A + 1e-12 * MatX::Identity(3, 3), -p.b);
  return (A * z + p.b).norm() < 1e-6 * unit && z[0] >= 0 &&
         std::hypot(z[1], z[2]) <= mu * z[0] * (1 + 1e-9);
}

}  // namespace

TEST_CASE("what is crushed between walls is refuted, and what is not is solved, in either form") {
  Random r(41);
  int refuted = 0, solved = 0;
  for (int k = 0; k < count(200); ++k) {
    const int bodies = 1 + int(r.below(k % 10 == 0 ? 40 : 8));
    const bool closing = r.below(2) == 0;
    const BlockProblem p = squeezed_row(r, bodies, closing ? r.uniform(0.01, 2) : -4.0);
    const LcpProblem whole = with_matrix(p);
    CAPTURE(k);
    CAPTURE(bodies);
    for (const bool by_blocks : {true, false}) {
      ConeTask task = task_of(p, by_blocks);
      const ConeAnswer answer = solve_cones(task);
      // The sum of the gaps' rates is that of the walls, whatever the bodies do.
      CHECK(answer.found == !closing);
      if (closing) {
        CHECK(answer.solution.report.status == LcpStatus::infeasible);
        CHECK(proves(whole, answer.solution.ray));
        // No stage comes after the proof.
        CHECK(answer.attempts.back().stage == "pivots");
        ++refuted;
      } else {
        CHECK(validate(whole, answer.solution.z).worst() <= task.tolerance);
        ++solved;
      }
    }
  }
  CHECK(refuted > 0);
  CHECK(solved > 0);
}

TEST_CASE("one group with a matrix that lacks a rank: refuted only where a search finds nothing") {
  Random r(42);
  int refuted = 0, found = 0, open = 0;
  for (int k = 0; k < count(400); ++k) {
    // Rows of one or two columns; now and then none for the axial unknown, as between two walls.
    MatX G = MatX::Zero(3, 2);
    const bool walls = r.below(4) == 0;
    for (int i = walls ? 1 : 0; i < 3; ++i)
      for (int j = 0; j < 1 + int(r.below(2)); ++j) G(i, j) = r.uniform(-1, 1);
    VecX b(3);
    for (int i = 0; i < 3; ++i) b[i] = r.uniform(-1, 1);
    LcpProblem p = LcpProblem::plain(MatX(G * G.transpose()), b);
    p.lower[1] = p.lower[2] = -inf;
    p.add_group(0, r.uniform(0.1, 1));
    CAPTURE(k);
    const auto answer = solve_without_laterals(p);
    REQUIRE(answer.ok());
    const bool proved = answer->report.status == LcpStatus::infeasible;
    CHECK(proved == (walls && b[0] < 0));
    if (proved) {
      ++refuted;
      CHECK(proves(p, answer->ray));
      CHECK_FALSE(one_group_has_solution(p));
    }
    ConeTask task;
    task.problem = p;
    const ConeAnswer best = solve_cones(task);
    if (best.found) CHECK(validate(p, best.solution.z).worst() <= 1e-9);
    found += best.found;
    open += b[0] >= 0;
    if (one_group_has_solution(p)) CHECK(best.found);
  }
  if (count(400) < 100) return;
  CHECK(refuted > count(10));
  CHECK(found > count(100));
  CHECK(open > count(100));
}

TEST_CASE("without groups the proof is that of enumeration") {
  Random r(43);
  int refuted = 0, solved = 0;
  for (int k = 0; k < count(300); ++k) {
    const int n = 1 + int(r.below(6));
    MatX G = MatX::Zero(n, 1 + int(r.below(2)));
    for (Eigen::Index i = 0; i < G.size(); ++i) G.data()[i] = double(r.below(5)) - 2;
    VecX b(n);
    for (int i = 0; i < n; ++i) b[i] = double(r.below(5)) - 2;
    const LcpProblem p = LcpProblem::plain(MatX(G * G.transpose()), b);
    ConeTask task;
    task.problem = p;
    const ConeAnswer answer = solve_cones(task);
    const auto reference = enumeration(p);
    REQUIRE(reference.ok());
    CAPTURE(k);
    CHECK(answer.found == reference->report.solved());
    CHECK((answer.solution.report.status == LcpStatus::infeasible) ==
          (reference->report.status == LcpStatus::infeasible));
    if (!answer.found) CHECK(proves(p, answer.solution.ray));
    (answer.found ? solved : refuted) += 1;
  }
  if (count(300) < 100) return;
  CHECK(refuted > 50);
  CHECK(solved > 50);
}

TEST_CASE("stages are tried in the order of their list, and every attempt is told") {
  Random r(44);
  for (int k = 0; k < count(100); ++k) {
    const BlockProblem p = squeezed_row(r, 1 + int(r.below(5)), r.uniform(-2, 2));
    ConeTask task = task_of(p, r.below(2) == 0);
    const ConeAnswer answer = solve_cones(task);
    REQUIRE_FALSE(answer.attempts.empty());
    auto at = all_cone_stages().begin();
    for (const ConeAttempt& attempt : answer.attempts) {
      at = std::find_if(at, all_cone_stages().end(),
                        [&](const ConeStage& s) { return s.name == attempt.stage; });
      REQUIRE(at != all_cone_stages().end());
      CHECK(at->applies(task));
      ++at;
    }
  }
}
