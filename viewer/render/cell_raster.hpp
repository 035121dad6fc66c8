#pragma once
#include "viewer/render/device.hpp"

namespace tumble {

/// Marks the coarse cells of a picture that contain something, and covers them with few rectangles.
class CellRaster {
 public:
  CellRaster(int width, int height);

  /// Marks the cells that a rectangle touches [px, from the lower left corner of the picture].
  void mark(const std::array<double, 2>& low, const std::array<double, 2>& high);
  void mark_all();

  /// Disjoint rectangles that cover all marked cells. They may cover unmarked cells too, where more
  /// rectangles would cost more than is saved.
  std::vector<ScissorRect> rectangles() const;

 private:
  int width_, height_, columns_, rows_;
  std::vector<uint8_t> marked_;  ///< one flag per cell, rows upwards
};

}  // namespace tumble
