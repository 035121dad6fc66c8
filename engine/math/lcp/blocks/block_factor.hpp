#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tumble::lcp {

/// L U of a sparse square matrix of 6 x 6 blocks with a symmetric pattern; rows are exchanged
/// within the blocks of the diagonal only, which is enough for what is nearly symmetric and
/// definite. Blocks are eliminated in the order of least degree (Tinney & Walker, "Direct solutions
/// of sparse network equations", 1967, scheme 2), ties by index.
class BlockFactor {
 public:
  /// Forgets all; the blocks off the diagonal that may be filled, each pair once, in either order.
  void set_pattern(int blocks, std::vector<std::pair<int, int>> pairs);
  /// Makes it the identity.
  void set_identity();
  /// Adds a 6 x 6 matrix, by columns, to a block that is in the pattern.
  void add(int row, int column, const double* m);
  /// False when a block on the diagonal is singular to working precision.
  bool factor();
  /// x := A^-1 x; only after a factor() that returned true.
  void solve(std::span<double> x) const;

  static constexpr int width = 6;
  using Block = std::array<double, width * width>;

 private:
  struct Link {
    int other;         ///< eliminated later
    int lower, upper;  ///< of blocks_: row `other` of this column, and this row, column `other`
  };
  const Link* find(int earlier, int later) const;
  bool eliminate(int k);

  int n_ = 0;
  std::vector<int> order_, place_;        ///< block eliminated at a step; step of a block
  std::vector<std::vector<Link>> links_;  ///< by block, those eliminated later, by step
  std::vector<Block> blocks_;             ///< first the diagonal ones
  std::vector<std::array<int, width>> swaps_;
};

}  // namespace tumble::lcp
