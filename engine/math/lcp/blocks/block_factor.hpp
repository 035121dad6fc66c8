#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tumble::lcp {

/// L U of a sparse square matrix of 6 x 6 blocks with a symmetric pattern. Rows are exchanged only
/// within diagonal blocks, which suffices for nearly symmetric definite matrices. Blocks are
/// eliminated in the order of least degree (Tinney & Walker, "Direct solutions of sparse network
/// equations", 1967, scheme 2), ties by index.
class BlockFactor {
 public:
  /// Resets the matrix; `pairs`: the off-diagonal blocks that may be nonzero, each pair once, in
  /// either order.
  void set_pattern(int blocks, std::vector<std::pair<int, int>> pairs);
  /// Sets the matrix to the identity.
  void set_identity();
  /// Adds a 6 x 6 matrix, by columns, to a block of the pattern.
  void add(int row, int column, const double* m);
  /// False when a block on the diagonal is singular to working precision.
  bool factor();
  /// x := A^-1 x; only after a factor() that returned true.
  void solve(std::span<double> x) const;

  static constexpr int width = 6;
  using Block = std::array<double, width * width>;

 private:
  struct Link {
    int other;  ///< eliminated later
    /// Indices into blocks_: row `other` of this column; this row, column `other`.
    int lower, upper;
  };
  const Link* find(int earlier, int later) const;
  bool eliminate(int k);

  int n_ = 0;
  std::vector<int> order_, place_;  ///< block eliminated at a step; step of a block
  /// By block: those eliminated later, in the order of elimination.
  std::vector<std::vector<Link>> links_;
  std::vector<Block> blocks_;  ///< diagonal blocks first
  std::vector<std::array<int, width>> swaps_;
};

}  // namespace tumble::lcp
