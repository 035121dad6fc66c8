#include "engine/math/lcp/cones/sliding_cones.hpp"

#include "engine/math/lcp/interior/cone_interior.hpp"
#include "engine/math/lcp/newton/cone_newton.hpp"
#include "engine/math/lcp/pivoting/enumeration.hpp"
#include "engine/math/lcp/validate.hpp"

#include <algorithm>

namespace tumble::lcp {
namespace {

constexpr double off_balance = 1e-8;  ///< of the greatest |b|, in units of the diagonal of A
constexpr double fast_slip = 1e4;     ///< of the greatest |b|
constexpr size_t few_units = 8;       ///< of which all sets can be tried

Error no_case(std::string_view why) {
  return {ErrorCode::unsupported, std::string(why), "lcp", {}};
}

}  // namespace

bool slides(const LcpProblem& problem) {
  return std::any_of(problem.groups.begin(), problem.groups.end(),
                     [](const ConeGroup& g) { return g.mode == ConeMode::sliding; });
}

bool balances(const LcpProblem& problem, const LcpSolution& solution) {
  const double alone = term_unit(problem, VecX::Zero(problem.size()));
  return solution.report.residual * term_unit(problem, solution.z) <= off_balance * alone;
}

Result<LcpSolution> solve_from_fast_slip(const LcpProblem& problem, bool few) {
  LcpProblem fast = problem;
  const double speed = fast_slip * problem.b.cwiseAbs().maxCoeff();
  for (ConeGroup& g : fast.groups) {
    if (g.mode != ConeMode::sliding) continue;
    g.mode = ConeMode::undecided;
    for (size_t k = 0; k < 2; ++k) fast.b[g.lateral[k]] += speed * g.direction[k];
  }
  Result<LcpSolution> start = few ? cone_newton(fast) : cone_interior(fast);
  if (!start || !start->report.solved()) return start;
  return cone_newton_from(problem, {}, start->z);
}

Result<LcpSolution> enumerate_sliding(const LcpProblem& problem) {
  std::vector<Eigen::Index> axial;
  MatX pushes = MatX::Identity(problem.size(), problem.size());
  std::vector<bool> lateral(size_t(problem.size()), false);
  for (const ConeGroup& g : problem.groups) {
    if (g.mode != ConeMode::sliding) return no_case("a group is undecided");
    for (size_t k = 0; k < 2; ++k) {
      pushes(g.lateral[k], g.axial) = -g.slope * g.direction[k];
      lateral[size_t(g.lateral[k])] = true;
    }
  }
  for (Eigen::Index i = 0; i < problem.size(); ++i)
    if (!lateral[size_t(i)]) axial.push_back(i);
  if (axial.size() > few_units) return no_case("too many sets to try");
  const MatX along = pushes(Eigen::all, axial);
  MatX A = MatX::Zero(along.cols(), along.cols());
  for (Eigen::Index c = 0; c < A.cols(); ++c)
    for (Eigen::Index r = 0; r < A.rows(); ++r)
      for (Eigen::Index k = 0; k < problem.size(); ++k)
        A(r, c) += problem.A(axial[size_t(r)], k) * along(k, c);
  Result<LcpSolution> solved = enumeration(LcpProblem::plain(A, problem.b(axial)));
  if (!solved) return solved;
  VecX z = VecX::Zero(problem.size());
  for (Eigen::Index c = 0; c < along.cols(); ++c) z += solved->z[c] * along.col(c);
  solved->z = z;
  return solved;
}

}  // namespace tumble::lcp
