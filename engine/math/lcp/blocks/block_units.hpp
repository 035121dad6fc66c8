#pragma once
#include "engine/math/lcp/blocks/block_factor.hpp"
#include "engine/math/lcp/blocks/block_problem.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble::lcp {

/// A group, or an unknown by itself, of a BlockProblem in scaled units.
struct BlockUnit {
  int count = 1;             ///< of rows: 1, or 3 with a group
  std::array<int, 3> row{};  ///< axial and lateral ones, or the unknown
  std::array<int, 2> block{-1, -1};
  std::array<std::array<double, 18>, 2> g{};  ///< by rows, 6 to each, for each block
  std::array<double, 9> own{};                ///< its part of A, by rows of 3
  const ConeGroup* group = nullptr;
  double lower = 0, upper = 0;  ///< of a single unknown
};

/// Rows and columns of G in scaled units (scaling.hpp), for products in a fixed order.
class BlockUnits {
 public:
  /// The problem must outlive it.
  explicit BlockUnits(const BlockProblem& problem);

  int n = 0;              ///< unknowns
  std::vector<double> d;  ///< units of the unknowns
  VecX b;
  std::vector<BlockUnit> units;

  /// u = G^T z
  void gather(const VecX& z, std::vector<double>& u) const;
  /// G u of one unit.
  std::array<double, 3> rows_times(const BlockUnit& unit, const std::vector<double>& u) const;
  /// u += G^T x of one unit.
  void add_rows(const BlockUnit& unit, const std::array<double, 3>& x,
                std::vector<double>& u) const;
  /// w = G u + b
  void slack(const std::vector<double>& u, VecX& w) const;
  /// The largest sum of a row's terms within its own unit, at most what it is with all of them.
  double own_terms(const VecX& z) const;
};

/// Adds the unit's part of G^T D G to a matrix; `d` is its part of D, by rows of 3.
void add_response(const BlockUnit& unit, const std::array<double, 9>& d, BlockFactor& factor);

}  // namespace tumble::lcp
