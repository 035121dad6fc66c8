#include "viewer/render/cell_raster.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// Side of a cell [px].
constexpr int cell = 32;
/// One more rectangle costs as much as this many cells.
constexpr int cells_of_one_more = 2;

/// A rectangle of cells.
struct CellPart {
  int x0, y0, x1, y1;
  int cells() const { return (x1 - x0) * (y1 - y0); }
  bool overlaps(const CellPart& p) const {
    return x0 < p.x1 && p.x0 < x1 && y0 < p.y1 && p.y0 < y1;
  }
  CellPart with(const CellPart& p) const {
    return {std::min(x0, p.x0), std::min(y0, p.y0), std::max(x1, p.x1), std::max(y1, p.y1)};
  }
};

/// Joins a run of cells to the rectangle that grows least by it, or begins a new one; rectangles
/// that the result overlaps are joined too.
void include_run(std::vector<CellPart>& parts, CellPart run) {
  int least = run.cells() + cells_of_one_more;
  CellPart joined = run;
  for (const CellPart& p : parts)
    if (const int growth = p.with(run).cells() - p.cells(); growth <= least) {
      least = growth;
      joined = p.with(run);
    }
  for (bool alone = false; !alone;) {
    alone = true;
    std::erase_if(parts, [&](const CellPart& p) {
      if (!p.overlaps(joined)) return false;
      joined = joined.with(p);
      alone = false;
      return true;
    });
  }
  parts.push_back(joined);
}

}  // namespace

CellRaster::CellRaster(int width, int height)
    : width_(width),
      height_(height),
      columns_((width + cell - 1) / cell),
      rows_((height + cell - 1) / cell),
      marked_(size_t(columns_) * size_t(rows_)) {}

void CellRaster::mark(const std::array<double, 2>& low, const std::array<double, 2>& high) {
  if (!(high[0] > 0 && high[1] > 0 && low[0] < width_ && low[1] < height_)) return;
  const auto cell_of = [](double x, int most) {
    return int(std::clamp(x, 0.0, double(most))) / cell;
  };
  const int right = std::min(cell_of(high[0], width_), columns_ - 1);
  const int top = std::min(cell_of(high[1], height_), rows_ - 1);
  for (int y = cell_of(low[1], height_); y <= top; ++y)
    for (int x = cell_of(low[0], width_); x <= right; ++x) marked_[size_t(y * columns_ + x)] = 1;
}

void CellRaster::mark_all() {
  std::fill(marked_.begin(), marked_.end(), uint8_t(1));
}

std::vector<ScissorRect> CellRaster::rectangles() const {
  std::vector<CellPart> parts;
  for (int y = 0; y < rows_; ++y) {
    CellPart run{0, y, 0, y + 1};  // empty at first
    for (int x = 0; x < columns_; ++x) {
      if (!marked_[size_t(y * columns_ + x)]) continue;
      const bool joins = run.cells() > 0 && x - run.x1 <= cells_of_one_more;
      if (run.cells() > 0 && !joins) include_run(parts, run);
      run = {joins ? run.x0 : x, y, x + 1, y + 1};
    }
    if (run.cells() > 0) include_run(parts, run);
  }
  std::vector<ScissorRect> out;
  for (const CellPart& p : parts) {
    const int right = std::min(p.x1 * cell, width_), top = std::min(p.y1 * cell, height_);
    out.push_back({p.x0 * cell, height_ - top, right - p.x0 * cell, top - p.y0 * cell});
  }
  return out;
}

}  // namespace tumble
