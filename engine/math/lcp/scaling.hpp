#pragma once
#include "engine/math/lcp/problem.hpp"

#include <vector>

namespace tumble::lcp {

/// Powers of two d with d_i^2 A_ii in [1/2, 2); one d for the three unknowns of a group, by the
/// greatest of their diagonal entries; 1 where the diagonal is not positive. With z = d z', w = w'
/// / d, A' = d A d, b' = d b all entries of a semi-definite A' are at most 2, whatever the units of
/// rows; the change is exact.
std::vector<double> scaling_of(const LcpProblem& problem);
/// The same from the diagonal of A.
std::vector<double> scaling_of(std::vector<double> diagonal, const std::vector<ConeGroup>& groups);

/// A problem in scaled units.
struct ScaledProblem {
  int n = 0;
  std::vector<double> d;  ///< units of the unknowns
  std::vector<double> A;  ///< by columns, n x n
  VecX b, lower, upper;

  explicit ScaledProblem(const LcpProblem& problem);
  const double* column(int j) const { return A.data() + std::ptrdiff_t(j) * n; }
  double at(int i, int j) const { return column(j)[i]; }
};

}  // namespace tumble::lcp
