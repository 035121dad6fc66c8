#pragma once
#include "viewer/app/window/view_area.hpp"
#include "viewer/render/ui_draw_list.hpp"
#include "viewer/ui/ui_rect.hpp"

namespace tumble {

/// Size of the window's picture, and the areas of panels and scene in it.
struct PictureLayout {
  struct Size {
    int width = 1280, height = 800;  ///< [px]
    double scale = 1;                ///< pixels per UI unit
    double display_period = 0;       ///< refresh period of the display; 0: not known [s]
  };
  Size size{0, 0, 1, 0};
  UiDrawList panels;
  UiRect free_area;  ///< left to the scene between the panels [UI units]
  ViewArea area;     ///< area of its picture, or of both pictures

  /// Area of the world's picture: alone, or `beside` that of another world.
  ViewArea area_in(const UiRect& free, bool beside) const {
    return beside ? ViewArea::beside(size.width, size.height, size.scale, free)
                  : ViewArea(size.width, size.height, size.scale);
  }
  /// The whole picture, without any panels [UI units].
  UiRect all() const {
    return {0, 0, float(size.width / size.scale), float(size.height / size.scale)};
  }
  float pixels(float units) const { return units * float(size.scale); }
};

}  // namespace tumble
