#include "viewer/render/flat_draw.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {

void FlatDraw::corner(float x, float y, uint32_t rgba) {
  const float u = font_.white_u, v = font_.white_v;
  out_.indices.push_back(uint32_t(out_.vertices.size()));
  out_.vertices.push_back({x, y, u, v, rgba});
}

void FlatDraw::triangle(float x0, float y0, float x1, float y1, float x2, float y2, uint32_t rgba) {
  corner(x0, y0, rgba);
  corner(x1, y1, rgba);
  corner(x2, y2, rgba);
}

void FlatDraw::box(float x0, float y0, float x1, float y1, uint32_t rgba) {
  triangle(x0, y0, x1, y0, x1, y1, rgba);
  triangle(x0, y0, x1, y1, x0, y1, rgba);
}

void FlatDraw::line(float x0, float y0, float x1, float y1, float width, uint32_t rgba) {
  const float dx = x1 - x0, dy = y1 - y0, length = std::sqrt(dx * dx + dy * dy);
  if (!(length > 0)) return;
  const float nx = -dy / length * 0.5f * width, ny = dx / length * 0.5f * width;
  triangle(x0 + nx, y0 + ny, x1 + nx, y1 + ny, x1 - nx, y1 - ny, rgba);
  triangle(x0 + nx, y0 + ny, x1 - nx, y1 - ny, x0 - nx, y0 - ny, rgba);
}

void FlatDraw::disc(float x, float y, float radius, uint32_t rgba) {
  constexpr int corners = 16;
  const auto at = [&](int i) {
    const double turn = 2 * det::pi * i / corners;
    return std::pair{x + radius * float(det::cos(turn)), y + radius * float(det::sin(turn))};
  };
  for (int i = 0; i < corners; ++i) {
    const auto [x0, y0] = at(i);
    const auto [x1, y1] = at(i + 1);
    triangle(x, y, x0, y0, x1, y1, rgba);
  }
}

void FlatDraw::text(std::string_view text, float x, float y, float size, uint32_t rgba) {
  const float scale = size / font_.line_height;
  while (!text.empty()) {
    const Glyph* g = font_.find(next_codepoint(text));
    if (!g) g = font_.find('?');
    if (!g) continue;
    if (g->x1 > g->x0) {
      const float x0 = x + g->x0 * scale, x1 = x + g->x1 * scale;
      const float y0 = y + g->y0 * scale, y1 = y + g->y1 * scale;
      const uint32_t base = uint32_t(out_.vertices.size());
      out_.vertices.push_back({x0, y0, g->u0, g->v0, rgba});
      out_.vertices.push_back({x1, y0, g->u1, g->v0, rgba});
      out_.vertices.push_back({x1, y1, g->u1, g->v1, rgba});
      out_.vertices.push_back({x0, y1, g->u0, g->v1, rgba});
      for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) out_.indices.push_back(base + k);
    }
    x += g->advance * scale;
  }
}

}  // namespace tumble
