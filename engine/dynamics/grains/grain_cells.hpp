#pragma once
#include "engine/dynamics/grains/grain_field.hpp"
#include "engine/dynamics/grains/near_kernels.hpp"

#include <vector>

namespace tumble {

/// The grains in the cells of a grid, and which are near those of a cell. Made anew for each part
/// of a tick, along the curve that the grains stand in: their order changes little, and there is no
/// memory that one fast grain among many could make worthless.
class GrainCells {
 public:
  /// `closes` is how far a grain may come in the part relative to the mean of all, by place, and
  /// `reach` how far apart centres of grains that are looked for are at most: no more than the edge
  /// of a cell [m]. Refuses places that cells cannot tell apart.
  Status sort(const GrainField& grains, std::span<const double> closes, double reach, Crew* crew);
  std::span<const CellOrder::Cell> cells() const { return cells_.cells(); }
  /// Place of the k-th grain in the order of the cells.
  uint32_t place(uint32_t k) const { return cells_.order()[k]; }
  /// Who is awake, for stirs(): some grain of this cell or of those about it, by index of the cell.
  void find_awake(const GrainField& grains, Crew* crew);
  bool stirs(size_t cell) const;

  /// What is within reach of a cell.
  class Near {
   public:
    void collect(const GrainCells& in, const CellOrder::Cell& cell);
    /// Those whose extent and that of the k-th grain meet when the latter is larger by `more`
    /// metres, and whose ordinals are above `after`: indices for place().
    std::span<const uint32_t> of(const GrainCells& in, uint32_t k, double more, int32_t after);
    uint32_t place(uint32_t n) const { return place_[n]; }

   private:
    void make_room(size_t size);
    GrainsNearCell view() {
      return {x_.data(), y_.data(), z_.data(), extent_.data(), place_.data(), ordinal_.data()};
    }
    Vec3 centre_ = Vec3::Zero();
    size_t padded_ = 0;
    std::vector<float> x_, y_, z_, extent_;
    std::vector<uint32_t> place_, found_;
    std::vector<int32_t> ordinal_;
  };

 private:
  GrainColumns columns() const {
    return {x_.data(), y_.data(), z_.data(), extent_.data(), place_.data(), ordinal_.data()};
  }
  template <class F>
  void about(const CellOrder::Cell& cell, const F& f) const;

  CellOrder cells_;
  double reach_ = 0;  ///< [m]
  std::vector<Vec3> points_;
  // In the order of the cells, then of what fills the last vector.
  std::vector<double> x_, y_, z_;
  std::vector<float> extent_;
  std::vector<uint32_t> place_;
  std::vector<int32_t> ordinal_;
  std::vector<uint8_t> awake_;  ///< by cell: some grain of it is
};

}  // namespace tumble
