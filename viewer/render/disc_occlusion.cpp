#include "viewer/render/disc_occlusion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// The first pixel whose centre is not below x. Rounds up by itself: without SSE 4.1 std::ceil is a
/// call, which took half of all the time here.
int pixel(float x, int limit) {
  const float within = std::clamp(x - 0.5f, 0.f, float(limit));
  const int below = int(within);
  return below + (float(below) < within);
}

/// The part of the picture's pixels that discs touch.
struct Raster {
  int width, height;                   ///< of the picture
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  ///< the part: from, and to before
  float* depth = nullptr;              ///< of the part, by rows

  Raster(const std::vector<ProjectedDisc>& discs, int picture_width, int picture_height)
      : width(picture_width), height(picture_height), x0(width), y0(height) {
    for (const ProjectedDisc& d : discs) {
      // One pixel more, for rounding.
      const float reach = std::max(d.cover_radius, d.outline_radius) + 1;
      x0 = std::min(x0, pixel(d.x - reach, width));
      y0 = std::min(y0, pixel(d.y - reach, height));
      x1 = std::max(x1, pixel(d.x + reach, width));
      y1 = std::max(y1, pixel(d.y + reach, height));
    }
  }
  size_t columns() const { return size_t(std::max(x1 - x0, 0)); }
  size_t pixels() const { return columns() * size_t(std::max(y1 - y0, 0)); }
};

/// Calls `row(begin, end)` for the pixels of each row whose centres lie within `radius`, until it
/// returns false. Where rows begin and end is computed for several of them at once: their square
/// roots then do not wait for what is done with the row before.
template <class Row>
bool over_rows(const Raster& r, const ProjectedDisc& d, float radius, const Row& row) {
  constexpr int most = 8;
  std::array<int, most> x0, x1;
  const int y1 = pixel(d.y + radius, r.height);
  for (int y0 = pixel(d.y - radius, r.height); y0 < y1; y0 += most) {
    for (int k = 0; k < most; ++k) {
      const float dy = float(y0 + k) + 0.5f - d.y;
      const float half = std::sqrt(std::max(radius * radius - dy * dy, 0.f));
      x0[size_t(k)] = pixel(d.x - half, r.width);
      x1[size_t(k)] = pixel(d.x + half, r.width);
    }
    for (int k = 0; k < std::min(most, y1 - y0); ++k) {
      const int begin = x0[size_t(k)], end = x1[size_t(k)];
      if (begin >= end) continue;
      float* const line = r.depth + size_t(y0 + k - r.y0) * r.columns();
      if (!row(line + (begin - r.x0), line + (end - r.x0))) return false;
    }
  }
  return true;
}

/// Depths that are compared at once: the compiler unrolls that. The last ones of a row may overlap
/// those before, which minimum and conjunction allow.
constexpr std::ptrdiff_t at_once = 4;

void lower_to(float depth, float* begin, float* end) {
  const auto lower = [depth](float* p) {
    for (int k = 0; k < at_once; ++k) p[k] = std::min(p[k], depth);
  };
  if (end - begin < at_once) {
    for (float* p = begin; p != end; ++p) *p = std::min(*p, depth);
    return;
  }
  for (float* p = begin; p < end - at_once; p += at_once) lower(p);
  lower(end - at_once);
}

bool all_below(float depth, const float* begin, const float* end) {
  const auto below = [depth](const float* p) {
    bool all = true;
    for (int k = 0; k < at_once; ++k) all &= p[k] < depth;
    return all;
  };
  if (end - begin < at_once) return std::all_of(begin, end, [depth](float d) { return d < depth; });
  for (const float* p = begin; p < end - at_once; p += at_once)
    if (!below(p)) return false;
  return below(end - at_once);
}

}  // namespace

void DiscOcclusion::find_hidden(const std::vector<ProjectedDisc>& discs, int width, int height,
                                std::vector<uint8_t>& hidden) {
  Raster raster(discs, width, height);
  depth_.assign(raster.pixels(), std::numeric_limits<float>::infinity());
  raster.depth = depth_.data();
  for (const ProjectedDisc& d : discs) {
    if (!(d.cover_radius > 0)) continue;
    over_rows(raster, d, d.cover_radius, [&](float* begin, float* end) {
      lower_to(d.cover_depth, begin, end);
      return true;
    });
  }
  hidden.resize(discs.size());
  for (size_t i = 0; i < discs.size(); ++i) {
    const ProjectedDisc& d = discs[i];
    hidden[i] = over_rows(raster, d, d.outline_radius, [&](const float* begin, const float* end) {
      return all_below(d.nearest_depth, begin, end);
    });
  }
}

}  // namespace tumble
