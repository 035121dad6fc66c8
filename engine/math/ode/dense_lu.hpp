#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace tumble::ode {

/// LU factors with partial pivoting in plain loops of fixed order: the same bits from every
/// compiler, which a library's blocked kernels do not promise. For the small systems of implicit
/// steps: 2/3 n^3 operations.
class DenseLu {
 public:
  /// Takes an n by n matrix by rows; false if a pivot is zero or not finite.
  [[nodiscard]] bool factor(std::span<const double> rows, size_t n);
  /// Replaces b by the solution. After a factor() that succeeded.
  void solve(std::span<double> b) const;

 private:
  size_t n_ = 0;
  std::vector<double> rows_;
  std::vector<size_t> swaps_;
};

}  // namespace tumble::ode
