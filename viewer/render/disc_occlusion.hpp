#pragma once
#include <cstdint>
#include <vector>

namespace tumble {

/// A sphere as some view sees it: two discs around the same point of the raster.
struct ProjectedDisc {
  float x = 0, y = 0;        ///< [px]
  float cover_radius = 0;    ///< [px] pixels with centres this near are hidden by it ...
  float cover_depth = 0;     ///< ... for everything farther than this
  float outline_radius = 0;  ///< [px] no pixel with its centre farther out is touched by it
  float nearest_depth = 0;   ///< of any of its points
};

/// Which of many small round things a view cannot see, as others of them stand before it. Where
/// thousands lie in a heap this spares a software renderer most of the drawing, and never changes
/// the picture: what is called hidden would fail the depth test at each of its pixels.
class DiscOcclusion {
 public:
  /// Fills `hidden` with one flag per disc. What lies outside the raster hides nothing and counts
  /// as hidden there.
  void find_hidden(const std::vector<ProjectedDisc>& discs, int width, int height,
                   std::vector<uint8_t>& hidden);

 private:
  std::vector<float> depth_;
};

}  // namespace tumble
