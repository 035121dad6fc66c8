#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace tumble {

/// P A = L U with partial pivoting, for general square matrices of a size known at run time, in
/// plain loops of fixed order: the same bits from every compiler. 2/3 n^3 operations.
class LuFactor {
 public:
  /// Factors the n x n matrix `a`, given by columns. Returns false if it is singular, that is if
  /// the greatest remaining entry of a column is at most `least` times the greatest entry of the
  /// matrix, or if a stop is requested.
  bool factor(std::span<const double> a, int n, double least = 1e-14);
  /// x := A^-1 x; only after a factor() that returned true.
  void solve(double* x) const;
  int size() const { return n_; }

 private:
  double* column(int j) { return a_.data() + std::ptrdiff_t(j) * n_; }
  const double* column(int j) const { return a_.data() + std::ptrdiff_t(j) * n_; }

  std::vector<double> a_;
  std::vector<int> swaps_;
  int n_ = 0;
};

}  // namespace tumble
