#pragma once

namespace tumble {

/// A rectangle [UI units], y down.
struct UiRect {
  float x = 0, y = 0, width = 0, height = 0;
  bool overlaps(const UiRect& o) const {
    return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
  }
};

}  // namespace tumble
