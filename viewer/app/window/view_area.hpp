#pragma once
#include "viewer/render/camera.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/ui/ui_rect.hpp"

#include <optional>

namespace tumble {

/// Area of the world's picture in the window: all of it or, in a comparison, two pictures beside
/// each other between the panels: world A on the left, world B on the right. Positions and lengths
/// in UI units, at whole pixels.
class ViewArea {
 public:
  ViewArea() = default;
  /// The whole window, with its size in pixels.
  ViewArea(int width_px, int height_px, double scale);
  /// Two halves of the area that the panels leave free.
  static ViewArea beside(int width_px, int height_px, double scale, const UiRect& free);

  /// Width of one picture.
  double width() const { return width_; }
  double height() const { return height_; }
  double aspect() const { return width_ / height_; }
  /// The camera for one picture, given that for the whole window: the picture is narrower but shows
  /// the same width of the scene.
  Camera seen_by(const Camera& camera) const { return heightened(camera, heightening_); }
  double heightening() const { return heightening_; }
  /// Left edge of the picture at x.
  double origin_at(double x) const { return is_right(x) ? right() : left(); }
  double left() const { return places_ ? places_->left / scale_ : 0; }
  double right() const { return places_ ? places_->right / scale_ : 0; }
  bool is_right(double x) const { return places_ && x >= right(); }
  const std::optional<SideBySide>& places() const { return places_; }

  /// Divides a range of x into two halves [px].
  static SideBySide halves(int from, int to);

 private:
  double width_ = 0, height_ = 0, scale_ = 1;
  /// Aspect ratio of the window over that of a picture, if that is narrower; else 1.
  double heightening_ = 1;
  std::optional<SideBySide> places_;
};

}  // namespace tumble
