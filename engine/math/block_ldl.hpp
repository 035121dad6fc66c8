#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace tumble {

/// L D L^T of a symmetric positive semi-definite matrix of small blocks, most of which are zero
/// (George & Liu 1981, ch. 5). Blocks are eliminated in the order of least degree, which makes no
/// block full that was zero where the graph of the blocks is chordal: of trees the cost is linear.
/// Rows that depend on those eliminated before them get no share of a solution, which leaves a
/// basis of the rows; where the right-hand side is in the range all equations hold all the same.
class BlockLdl {
 public:
  BlockLdl() = default;
  /// The sizes of the blocks, and the pairs of different blocks that are not zero.
  BlockLdl(std::span<const uint32_t> sizes, std::span<const std::pair<uint32_t, uint32_t>> coupled);

  size_t size() const { return diagonal_.size(); }
  uint32_t first_row(uint32_t block) const { return first_[block]; }
  /// Rows that depended on others when factor() was called last.
  size_t dependent() const { return dependent_; }

  /// All zero again.
  void clear();
  /// Adds to the entry in row r of block i and column c of block j; of a diagonal block every entry
  /// is added, of two coupled blocks only one of (i, j) and (j, i).
  void add(uint32_t i, uint32_t r, uint32_t j, uint32_t c, double value);
  void factor();

  /// x := L^-1 x; cheap where x has few entries that are not zero.
  void forward(std::span<double> x) const;
  /// 1 / D by row, 0 for rows that depend on others.
  std::span<const double> inverse_pivots() const { return inverse_; }
  /// x := (L D L^T)^+ x.
  void solve(std::span<double> x) const;

 private:
  /// The columns of a block: its own rows, then those of the blocks below, column by column.
  struct Panel {
    uint32_t block = 0, columns = 0, rows = 0;
    size_t values = 0;              ///< where its entries begin
    std::vector<uint32_t> below;    ///< places in the order of elimination, ascending
    std::vector<uint32_t> row_of;   ///< first row of each in the panel
    std::vector<size_t> goes_to;    ///< entries that each pair of `below` is taken from
    std::vector<uint32_t> strides;  ///< rows of the panels there
  };
  void order(std::span<const uint32_t> sizes,
             std::span<const std::pair<uint32_t, uint32_t>> coupled);
  void lay_out(std::span<const uint32_t> sizes);
  size_t entry(uint32_t place, uint32_t row_place) const;
  void choose_column(const Panel& panel, uint32_t c, std::span<double> left);
  void factor_columns(Panel& panel);
  void update_below(const Panel& panel);

  std::vector<Panel> panels_;    ///< in the order of elimination
  std::vector<uint32_t> first_;  ///< by block: first row
  std::vector<uint32_t> place_;  ///< by block
  std::vector<double> values_;
  std::vector<double> diagonal_, pivot_, inverse_;  ///< by row
  std::vector<uint32_t> row_of_column_;             ///< in its block: rows change places
  std::vector<double> left_;
  size_t dependent_ = 0;
};

}  // namespace tumble
