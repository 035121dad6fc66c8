#pragma once
#include "viewer/render/device.hpp"

namespace tumble {

/// Which parts of a picture something is in, as a raster of coarse cells and then as rectangles.
class CellRaster {
 public:
  CellRaster(int width, int height);

  /// Cells that this rectangle touches [px], from the lower left corner of the picture.
  void mark(const std::array<double, 2>& low, const std::array<double, 2>& high);
  void mark_all();

  /// Rectangles without overlap that hold all marked cells, and others where to leave them out
  /// would cost more than it spares.
  std::vector<ScissorRect> rectangles() const;

 private:
  int width_, height_, columns_, rows_;
  std::vector<uint8_t> marked_;  ///< of each cell, rows upwards
};

}  // namespace tumble
