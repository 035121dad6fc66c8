#include "viewer/render/disc_occlusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

struct Raster {
  std::vector<float>& depth;
  int width, height;
};

/// Calls `row(begin, end)` for the pixels of each row whose centres lie within `radius`, until it
/// returns false.
template <class Row>
bool over_rows(const Raster& r, const ProjectedDisc& d, float radius, const Row& row) {
  const auto pixel = [](float x, int limit) {
    return int(std::clamp(std::ceil(x - 0.5f), 0.f, float(limit)));
  };
  const int y1 = pixel(d.y + radius, r.height);
  for (int y = pixel(d.y - radius, r.height); y < y1; ++y) {
    const float dy = float(y) + 0.5f - d.y;
    const float half = std::sqrt(std::max(radius * radius - dy * dy, 0.f));
    float* const line = r.depth.data() + size_t(y) * size_t(r.width);
    const int x0 = pixel(d.x - half, r.width), x1 = pixel(d.x + half, r.width);
    if (x0 < x1 && !row(line + x0, line + x1)) return false;
  }
  return true;
}

}  // namespace

void DiscOcclusion::find_hidden(const std::vector<ProjectedDisc>& discs, int width, int height,
                                std::vector<uint8_t>& hidden) {
  depth_.assign(size_t(width) * size_t(height), std::numeric_limits<float>::infinity());
  const Raster raster{depth_, width, height};
  for (const ProjectedDisc& d : discs) {
    if (!(d.cover_radius > 0)) continue;
    over_rows(raster, d, d.cover_radius, [&](float* begin, float* end) {
      for (float* p = begin; p != end; ++p) *p = std::min(*p, d.cover_depth);
      return true;
    });
  }
  hidden.resize(discs.size());
  for (size_t i = 0; i < discs.size(); ++i) {
    const ProjectedDisc& d = discs[i];
    hidden[i] = over_rows(raster, d, d.outline_radius, [&](const float* begin, const float* end) {
      bool all = true;
      for (const float* p = begin; p != end; ++p) all &= *p < d.nearest_depth;
      return all;
    });
  }
}

}  // namespace tumble
