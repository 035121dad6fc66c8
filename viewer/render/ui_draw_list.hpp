#pragma once
#include <array>
#include <cstdint>
#include <vector>

namespace tumble {

/// A corner of a panel's triangle: position in UI units (top left origin, y down).
struct UiVertex {
  float x = 0, y = 0;
  float u = 0, v = 0;
  uint32_t rgba = 0xffffffff;  ///< sRGB, red in the lowest byte
};
static_assert(sizeof(UiVertex) == 20);

/// Texture of a UI draw. 0 is the font atlas given to Renderer::set_font.
using UiTextureId = uint32_t;

struct UiDraw {
  uint32_t first_index = 0;
  uint32_t index_count = 0;
  uint32_t base_vertex = 0;
  std::array<float, 4> clip{};  ///< x0, y0, x1, y1 in UI units; half open
  UiTextureId texture = 0;
};

/// The output of an immediate-mode UI: triangles in order, blended over the picture.
struct UiDrawList {
  float width = 0, height = 0;  ///< size of the picture in UI units; 0: equal to its pixels
  std::vector<UiVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<UiDraw> draws;
};

}  // namespace tumble
