#pragma once
#include "engine/core/crew.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Points sorted by the cubic cells of a grid in which they lie, with cells along Morton's
/// space-filling curve (1966); points of a cell keep their order. Only cells that contain points
/// take memory (compact hashing: Ihmsen, Akinci, Becker, Teschner, "A parallel SPH implementation
/// on multi-core CPUs", 2011). Cell coordinates are taken modulo 2^21, so that cells very far apart
/// may share an entry: points of a cell are candidates only, whose distances must be checked.
class CellOrder {
 public:
  struct Cell {
    int64_t i, j, k;
    uint32_t first, end;  ///< range of order()
    bool at(int64_t ci, int64_t cj, int64_t ck) const { return i == ci && j == cj && k == ck; }
  };

  /// Cells of edge length `size` [m], one corner at the origin.
  void sort(std::span<const Vec3> points, double size, Crew* crew = nullptr);
  /// Computes only order(), without cells; points of cells that are 2^21 apart may be mixed.
  void line_up(std::span<const Vec3> points, double size, Crew* crew = nullptr);

  /// Indices of the points, cell by cell.
  std::span<const uint32_t> order() const { return order_; }
  std::span<const Cell> cells() const { return cells_; }
  /// Null if the cell contains no points.
  const Cell* find(int64_t i, int64_t j, int64_t k) const;
  /// The cell and those of its 26 neighbours that contain points: along i, then j, then k. Returns
  /// their number.
  size_t about(const Cell& cell, std::array<const Cell*, 27>& out) const;
  double size() const { return size_; }

 private:
  void make_keys(std::span<const Vec3> points, Crew* crew);
  void sort_keys(Crew* crew);
  void list_cells(std::span<const Vec3> points);
  void fill_table();
  const Cell* find(uint64_t code, int64_t i, int64_t j, int64_t k) const;

  double size_ = 1;
  std::vector<uint32_t> order_;
  std::vector<Cell> cells_;
  std::vector<uint32_t> table_;  ///< hash table: index of a cell plus one; 0 if free
  struct Keyed {
    uint64_t key;
    uint32_t index;
  };
  std::vector<Keyed> keyed_, scratch_;
  static constexpr int digit_bits = 11;
  /// By digit: number of keys with it; then the place of the next one.
  using Digits = std::array<uint32_t, 1 << digit_bits>;
  std::vector<Digits> digits_;  ///< by chunk
};

}  // namespace tumble
