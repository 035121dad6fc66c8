#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// L D L^T of a symmetric sparse matrix of small blocks (George & Liu 1981, ch. 5). Blocks are
/// eliminated in the order of least degree, which causes no fill-in if the graph of the blocks is
/// chordal: for trees the cost is linear.
///
/// The matrix must be positive semi-definite. Rows that depend on those eliminated before them get
/// 0 in a solution, which leaves a basis of the rows; if the right-hand side is in the range, all
/// equations hold.
class BlockLdl {
 public:
  BlockLdl() = default;
  /// `sizes` of the blocks; `coupled`: the pairs of different blocks that are not zero.
  BlockLdl(std::span<const uint32_t> sizes, std::span<const std::pair<uint32_t, uint32_t>> coupled);

  size_t size() const { return diagonal_.size(); }
  uint32_t first_row(uint32_t block) const { return first_[block]; }
  /// Rows that depended on others when factor() was called last.
  size_t dependent() const { return dependent_; }
  bool depends(size_t row) const { return inverse_[row] == 0; }

  /// Address of entry (r, c) of a block: values()[first + r * row_step + c * column_step].
  struct Place {
    size_t first, row_step, column_step;
  };
  /// Of a diagonal block every entry is stored; of two coupled blocks only one of (i, j) and (j,
  /// i), to which both places refer.
  Place place(uint32_t i, uint32_t j) const;
  std::span<double> values() { return values_; }

  /// Sets all entries to zero.
  void clear();
  /// Adds to the entry in row r of block i and column c of block j.
  void add(uint32_t i, uint32_t r, uint32_t j, uint32_t c, double value) {
    const Place at = place(i, j);
    values_[at.first + r * at.row_step + c * at.column_step] += value;
  }
  void factor();

  /// x := (L D L^T)^+ x.
  void solve(std::span<double> x) const;

 private:
  /// The columns of a block: its own rows, then those of the blocks below, stored column by column.
  struct Panel {
    uint32_t block = 0, columns = 0, rows = 0;
    size_t values = 0;            ///< index of its first entry
    size_t below = 0, pairs = 0;  ///< indices of its first Below and its first Target
    uint32_t count = 0;           ///< number of blocks below
  };
  /// A block below the columns of another.
  struct Below {
    uint32_t place;    ///< position in the order of elimination
    uint32_t row;      ///< its first row in the panel
    uint32_t columns;  ///< number of its rows here
    uint32_t first;    ///< first row in the matrix
  };
  /// Destination of the update by a pair of blocks below.
  struct Target {
    size_t first;
    uint32_t rows;  ///< number of rows of the panel there
  };
  std::vector<std::vector<uint32_t>> order(size_t blocks,
                                           std::span<const std::pair<uint32_t, uint32_t>> coupled);
  void lay_out(std::span<const uint32_t> sizes, std::span<std::vector<uint32_t>> below);
  size_t entry(uint32_t place, uint32_t row_place) const;
  void choose_column(const Panel& panel, uint32_t c, std::span<double> left);
  void factor_columns(const Panel& panel);
  void update_below(const Panel& panel);

  std::vector<Panel> panels_;  ///< in the order of elimination
  std::vector<Below> below_;
  std::vector<Target> targets_;
  std::vector<uint32_t> first_;  ///< by block: first row
  std::vector<uint32_t> place_;  ///< by block: position in the order of elimination
  std::vector<double> values_;
  std::vector<double> diagonal_, pivot_, inverse_;  ///< by row
  std::vector<uint32_t> row_of_column_;             ///< in its block: rows change places
  std::vector<double> left_;
  size_t dependent_ = 0;
};

}  // namespace tumble
