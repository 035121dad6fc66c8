#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/grains/near_kernels.hpp"

#include <vector>

namespace tumble {

/// The grains in the cells of a grid, for finding those near a cell. Made anew for each part of a
/// tick, along the space-filling curve in which the grains are stored: their order changes little,
/// and no cached list can be invalidated by a single fast grain.
class GrainCells {
 public:
  /// `ways`: by place, how a grain may move in the part relative to the mean of all grains [m].
  /// `reach`: greatest distance of centres that are searched for, at most the edge of a cell [m].
  /// Error if coordinates are too large for the grid.
  Status sort(const GrainField& grains, std::span<const Vec3> ways, double reach, Crew* crew);
  std::span<const CellOrder::Cell> cells() const { return cells_.cells(); }
  /// Place of the k-th grain in the order of cells.
  uint32_t place(uint32_t k) const { return cells_.order()[k]; }
  /// Prepares stirs(cell): whether any grain of this cell or of its neighbours is awake, by index
  /// of the cell.
  void find_awake(const GrainField& grains, Crew* crew);
  bool stirs(size_t cell) const;

  /// The grains within reach of a cell.
  class Near {
   public:
    void collect(const GrainCells& in, const CellOrder::Cell& cell);
    /// Grains that the k-th one may meet in the part, as far as it is foreseen, or comes within
    /// `more` metres of, and whose ordinals are above `after`: indices for place(). Those of which
    /// rounding decides have the bit doubtful_grain.
    std::span<const uint32_t> of(const GrainCells& in, uint32_t k, double more, int32_t after);
    uint32_t place(uint32_t n) const { return place_[n & ~doubtful_grain]; }
    uint32_t ordinal(uint32_t n) const { return uint32_t(ordinal_[n & ~doubtful_grain]); }

   private:
    void make_room(size_t size);
    GrainsNearCell view() {
      return {x_.data(),     y_.data(),     z_.data(),     extent_.data(), radius_.data(),
              way_x_.data(), way_y_.data(), way_z_.data(), place_.data(),  ordinal_.data()};
    }
    Vec3 centre_ = Vec3::Zero();
    size_t padded_ = 0;
    std::vector<float> x_, y_, z_, extent_, radius_, way_x_, way_y_, way_z_;
    std::vector<uint32_t> place_, found_;
    std::vector<int32_t> ordinal_;
  };

 private:
  GrainColumns columns() const {
    return {x_.data(),     y_.data(),     z_.data(),     extent_.data(), radius_.data(),
            way_x_.data(), way_y_.data(), way_z_.data(), place_.data(),  ordinal_.data()};
  }
  template <class F>
  void about(const CellOrder::Cell& cell, const F& f) const;

  CellOrder cells_;
  double reach_ = 0;  ///< greatest distance of centres [m]
  std::vector<Vec3> points_;
  // In the order of the cells, followed by padding up to a full vector.
  std::vector<double> x_, y_, z_;
  std::vector<float> extent_, radius_, way_x_, way_y_, way_z_;
  std::vector<uint32_t> place_;
  std::vector<int32_t> ordinal_;
  std::vector<uint8_t> awake_;  ///< by cell: some grain of it is awake
};

}  // namespace tumble
