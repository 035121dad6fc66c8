#include "engine/math/lcp/problem.hpp"

#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <fmt/format.h>

namespace tumble::lcp {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Error bad(std::string message, std::string cure = {}) {
  return {ErrorCode::invalid_argument, std::move(message), "lcp", std::move(cure)};
}

/// 0 if all x are finite, else NaN: such sums vectorise in any order.
double not_finite(const double* x, Eigen::Index n) {
  double sum = 0;
  for (Eigen::Index i = 0; i < n; ++i) sum += x[i] * 0.0;
  return sum;
}

Status check_sizes(const LcpProblem& p) {
  const auto n = p.b.size();
  if (n > 20000) return bad(fmt::format("{} unknowns are too many: at most 20000", n));
  if (p.lower.size() != n || p.upper.size() != n)
    return bad(fmt::format("{} lower and {} upper bounds for {} unknowns", p.lower.size(),
                           p.upper.size(), n));
  return {};
}

Status check_matrix(const LcpProblem& p) {
  const auto n = p.b.size();
  if (p.A.rows() != n || p.A.cols() != n)
    return bad(fmt::format("A is {} x {}, b has {} entries", p.A.rows(), p.A.cols(), n),
               "A must be square, of the size of b");
  for (Eigen::Index j = 0; j < n; ++j)
    if (not_finite(p.A.data() + j * n, n) != 0)
      return bad(fmt::format("column {} of A has an entry that is not finite", j));
  return {};
}

Status check_values(const LcpProblem& p) {
  const auto n = p.b.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!std::isfinite(p.b[i])) return bad(fmt::format("b[{}] = {} is not finite", i, p.b[i]));
    if (!(p.lower[i] <= p.upper[i]))
      return bad(fmt::format("bounds of unknown {}: lower {} is not <= upper {}", i, p.lower[i],
                             p.upper[i]));
    if (p.lower[i] == infinity || p.upper[i] == -infinity)
      return bad(
          fmt::format("bounds of unknown {} leave nothing: {} to {}", i, p.lower[i], p.upper[i]));
  }
  return {};
}

Status check_group(const LcpProblem& p, size_t k, std::vector<bool>& used) {
  const ConeGroup& g = p.groups[k];
  for (const int i : {g.axial, g.lateral[0], g.lateral[1]}) {
    if (i < 0 || i >= p.size())
      return bad(fmt::format("group {} names unknown {} of {}", k, i, p.size()));
    if (used[size_t(i)]) return bad(fmt::format("unknown {} is in two places of groups", i));
    used[size_t(i)] = true;
  }
  if (p.lower[g.axial] != 0 || p.upper[g.axial] != infinity)
    return bad(fmt::format("axial unknown {} of group {} must have the bounds 0 and infinity",
                           g.axial, k));
  for (const int i : g.lateral)
    if (p.lower[i] != -infinity || p.upper[i] != infinity)
      return bad(fmt::format("lateral unknown {} of group {} must have no bounds", i, k));
  if (!(g.slope >= 0) || g.slope == infinity)
    return bad(fmt::format("slope of group {} must be >= 0 and finite, got {}", k, g.slope));
  if (g.mode == ConeMode::sliding) {
    const double length =
        std::sqrt(g.direction[0] * g.direction[0] + g.direction[1] * g.direction[1]);
    if (!(std::fabs(length - 1) < tolerances::direction_length))
      return bad(fmt::format("direction of sliding group {} has length {}, not 1", k, length));
  }
  return {};
}

}  // namespace

LcpProblem LcpProblem::plain(MatX A, VecX b) {
  const auto n = b.size();
  return {std::move(A), std::move(b), VecX::Zero(n), VecX::Constant(n, infinity), {}};
}

ConeGroup& LcpProblem::add_group(int axial, double slope) {
  ConeGroup& group = groups.emplace_back();
  group.axial = axial;
  group.lateral = {axial + 1, axial + 2};
  group.slope = slope;
  return group;
}

Status check(const LcpProblem& p) {
  if (Status s = check_matrix(p); !s) return s;
  return check_conditions(p);
}

Status check_conditions(const LcpProblem& p) {
  if (Status s = check_sizes(p); !s) return s;
  if (Status s = check_values(p); !s) return s;
  std::vector<bool> used(size_t(p.size()), false);
  for (size_t k = 0; k < p.groups.size(); ++k)
    if (Status s = check_group(p, k, used); !s) return s;
  return {};
}

Status check_symmetric(const LcpProblem& p) {
  const int n = p.size();
  constexpr int block = 32;  // both halves of a pair of blocks stay in the cache
  for (int jb = 0; jb < n; jb += block)
    for (int ib = 0; ib <= jb; ib += block)
      for (int j = jb; j < std::min(n, jb + block); ++j)
        for (int i = ib; i < std::min(j, ib + block); ++i) {
          const double d = p.A(i, j) - p.A(j, i);
          if (d != 0 && d * d > tolerances::asymmetry2 * std::fabs(p.A(i, i) * p.A(j, j)))
            return bad(fmt::format("A is not symmetric: A[{0},{1}] = {2}, A[{1},{0}] = {3}", i, j,
                                   p.A(i, j), p.A(j, i)),
                       "use lemke for general matrices");
        }
  return {};
}

}  // namespace tumble::lcp
