#pragma once
#include <cstdint>
#include <vector>

namespace tumble {

/// A sphere in one view, bounded by two concentric discs: an inner one that it certainly covers and
/// an outer one that it stays within.
struct ProjectedDisc {
  float x = 0, y = 0;        ///< [px]
  float cover_radius = 0;    ///< [px] pixels whose centres are within this radius are covered ...
  float cover_depth = 0;     ///< ... and hide everything deeper than this
  float outline_radius = 0;  ///< [px] the sphere touches no pixel whose centre is farther away
  float nearest_depth = 0;   ///< the least depth of any of its points
};

/// Occlusion culling of many small spheres by each other. In a heap of thousands this saves a
/// software renderer most of the drawing. It is conservative: whatever is called hidden would fail
/// the depth test at each of its pixels, so the picture never changes.
class DiscOcclusion {
 public:
  /// Fills `hidden` with one flag per disc. Discs outside the raster (width x height cells) hide
  /// nothing and are flagged hidden.
  void find_hidden(const std::vector<ProjectedDisc>& discs, int width, int height,
                   std::vector<uint8_t>& hidden);

 private:
  std::vector<float> depth_;
};

}  // namespace tumble
