#pragma once
#include "engine/math/lcp/blocks/block_factor.hpp"
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/system/cone_system.hpp"

#include <array>
#include <vector>

namespace tumble::lcp {

/// The rows of G of a unit, in scaled units.
struct BlockEntries {
  std::array<int, 2> block{-1, -1};
  std::array<std::array<double, 18>, 2> g{};  ///< by rows of 6, for each block
  Square own{};                               ///< the unit's diagonal block of A
};

/// Rows and columns of G in scaled units (scaling.hpp), for products in a fixed order. Units are
/// referred to by their index in the lists.
class BlockUnits {
 public:
  /// The problem must outlive it.
  explicit BlockUnits(const BlockProblem& problem);

  int n = 0;              ///< unknowns
  std::vector<double> d;  ///< units of the unknowns
  VecX b;
  std::vector<ConeUnit> parts;
  std::vector<BlockEntries> entries;  ///< by part

  /// Sets the pattern of a matrix for G^T D G, with D block diagonal by units.
  void set_pattern(int blocks, BlockFactor& factor) const;
  /// Adds a unit's contribution to G^T D G; `response` is its block of D.
  void add_response(size_t unit, const Square& response, BlockFactor& factor) const;
  /// u = G^T z
  void gather(const VecX& z, std::vector<double>& u) const;
  /// G u of one unit.
  Triple rows_times(size_t unit, const std::vector<double>& u) const;
  /// u += G^T x of one unit.
  void add_rows(size_t unit, const Triple& x, std::vector<double>& u) const;
  /// The largest sum of a row's absolute terms within its own unit, at most that of all its terms.
  double own_terms(const VecX& z) const;
};

}  // namespace tumble::lcp
