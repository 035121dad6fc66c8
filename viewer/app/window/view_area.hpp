#pragma once
#include "viewer/render/camera.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/ui/ui_rect.hpp"

#include <optional>

namespace tumble {

/// Where the picture of the world stands in the window: all of it, or twice, beside each other:
/// world A on the left, world B on the right, between the panels. Places and lengths in UI units,
/// in whole pixels.
class ViewArea {
 public:
  ViewArea() = default;
  /// The whole window, of so many pixels.
  ViewArea(int width_px, int height_px, double scale);
  /// Two halves of what the panels leave free.
  static ViewArea beside(int width_px, int height_px, double scale, const UiRect& free);

  /// Of one picture.
  double width() const { return width_; }
  double height() const { return height_; }
  double aspect() const { return width_ / height_; }
  /// What the camera of the whole window is in one picture: half as wide, that shows as much from
  /// left to right.
  Camera seen_by(const Camera& camera) const { return heightened(camera, heightening_); }
  double heightening() const { return heightening_; }
  /// Of the picture at this place: its left edge.
  double origin_at(double x) const { return is_right(x) ? right() : left(); }
  double left() const { return places_ ? places_->left / scale_ : 0; }
  double right() const { return places_ ? places_->right / scale_ : 0; }
  bool is_right(double x) const { return places_ && x >= right(); }
  const std::optional<SideBySide>& places() const { return places_; }

  /// Halves of a part of a picture [px].
  static SideBySide halves(int from, int to);

 private:
  double width_ = 0, height_ = 0, scale_ = 1;
  double heightening_ = 1;  ///< aspect of the window over that of a picture, where it is narrower
  std::optional<SideBySide> places_;
};

}  // namespace tumble
