#pragma once
#include <cstddef>
#include <vector>

namespace tumble::lcp {

/// L D L^T of the submatrix of a symmetric positive definite matrix with a set of indices to which
/// indices are appended, and from which any index can be removed. A deletion is a rank-one update
/// with a positive factor, which is as stable as a new factorisation (Gill, Golub, Murray &
/// Saunders 1974, method C1). Each operation costs O(m^2) for m members.
class LdlFactor {
 public:
  /// Removes all members; reserves memory for `capacity`.
  void reset(int capacity);

  int size() const { return int(members_.size()); }
  /// The indices in the order in which vectors of this class list them.
  const std::vector<int>& members() const { return members_; }
  double pivot(int k) const { return d_[std::size_t(k)]; }

  /// y := L^-1 y.
  void forward(double* y) const;
  /// y := L^-T y.
  void backward(double* y) const;
  /// y := (L D L^T)^-1 y.
  void solve(double* y) const;

  /// Schur complement of a new diagonal entry: diagonal - y D^-1 y, with y = L^-1 (the column of
  /// the new index in the rows of the members).
  double remainder(double diagonal, const double* y) const;
  /// Appends an index with these y and remainder (> 0).
  void append(int index, const double* y, double remainder);
  /// Removes the member at `position`.
  void remove(int position);

 private:
  double* column(int j) { return l_.data() + std::ptrdiff_t(j) * stride_; }
  const double* column(int j) const { return l_.data() + std::ptrdiff_t(j) * stride_; }

  std::vector<int> members_;
  std::vector<double> d_, l_, scratch_;  // l_ by columns; the unit diagonal is not stored
  int stride_ = 0;
};

}  // namespace tumble::lcp
