#include "viewer/app/window/view_area.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

ViewArea::ViewArea(int width_px, int height_px, double scale)
    : width_(width_px / scale), height_(height_px / scale), scale_(scale) {}

SideBySide ViewArea::halves(int from, int to) {
  constexpr int gap = 2;  // dark line between the two pictures
  const int width = std::max((to - from - gap) / 2, 1);
  return {from, std::max(to - width, from), width};
}

ViewArea ViewArea::beside(int width_px, int height_px, double scale, const UiRect& free) {
  // As between panels and the edges of the window or the scene.
  constexpr float margin = 10, gap = 8;
  constexpr double least = 200;  // a narrower picture extends below the panels
  ViewArea out(width_px, height_px, scale);
  const double right = double(free.x + free.width);
  double from = free.x > margin ? double(free.x - gap) : 0.0;
  double to = right < out.width_ - margin ? right + gap : out.width_;
  if (to - from < least) {
    from = 0;
    to = out.width_;
  }
  out.places_ = halves(int(std::lround(from * scale)), int(std::lround(to * scale)));
  out.heightening_ = std::max(double(width_px) / out.places_->width, 1.0);
  out.width_ = out.places_->width / scale;
  return out;
}

}  // namespace tumble
