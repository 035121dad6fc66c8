#include "viewer/render/plate.hpp"

#include "viewer/render/flat_draw.hpp"
#include "viewer/render/ink.hpp"
#include "viewer/render/labels.hpp"
#include "viewer/render/marks.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

struct PlateColours {
  static constexpr uint32_t ground = 0xDD20180Fu, letters = 0xFFF2EEEAu, body = 0xFFDCD5CDu,
                            faint = 0xFFB6AC9Eu, accent = 0xFF6FB4F7u;
};

/// Measures of the layout of a plate [px].
struct PlateMeasure {
  float width, height, text, margin, top;
};

PlateMeasure plate_measure(int width, int height, float ui_scale, float top) {
  PlateMeasure m;
  m.top = top;
  m.width = float(width);
  m.height = float(height);
  // whole multiples of the bitmap font's 13 pixels stay sharp
  const float unit = std::max(1.0f, std::round(m.height / 380 / ui_scale)) * ui_scale;
  m.text = 13 * unit;
  m.margin = 8 * unit;
  return m;
}

void add_plate_caption(const Plate& p, const PlateMeasure& m, FlatDraw& draw) {
  const float line = 1.15f * m.text, inner = m.width - 4 * m.margin;
  const std::vector<std::string> lines = wrapped(p.caption, draw.font(), m.text, inner);
  const float heading = text_width(p.heading + "   ", draw.font(), m.text);
  const float counter = text_width(p.counter, draw.font(), m.text);
  const bool narrow = heading + text_width(p.title + "   ", draw.font(), m.text) + counter > inner;
  const float title = std::floor((narrow ? 2.6f : 1.4f) * m.text);  // two lines, or all in one
  const float tall = std::floor(1.6f * m.margin + title + line * float(lines.size()));
  const float x = 2 * m.margin, top = m.height - tall - m.margin;
  draw.box(m.margin, top, m.width - m.margin, m.height - m.margin, PlateColours::ground);
  draw.box(m.margin, top, m.margin + 0.35f * m.margin, m.height - m.margin, PlateColours::accent);
  float y = std::floor(top + 0.8f * m.margin);
  draw.text(p.heading, x, y, m.text, PlateColours::accent);
  draw.text(p.title, std::floor(narrow ? x : x + heading),
            narrow ? y + std::floor(1.2f * m.text) : y, m.text, PlateColours::letters);
  draw.text(p.counter, std::floor(m.width - 2 * m.margin - counter), y, m.text,
            PlateColours::faint);
  y += title;
  for (const std::string& text : lines) {
    draw.text(text, x, y, m.text, PlateColours::body);
    y += std::floor(line);
  }
}

void add_numbers(const Plate& p, const PlateMeasure& m, FlatDraw& draw) {
  const float size = m.text, line = std::floor(1.2f * size);
  if (p.numbers.empty()) return;
  float labels = 0, values = 0;
  for (const auto& [label, value] : p.numbers) {
    labels = std::max(labels, text_width(label, draw.font(), size));
    values = std::max(values, text_width(value, draw.font(), size));
  }
  const float inner = labels + 2 * m.margin + values;
  const float tall = 1.6f * m.margin + line * float(p.numbers.size());
  draw.box(m.margin, m.top + m.margin, 3 * m.margin + inner, m.top + m.margin + tall,
           PlateColours::ground);
  const float x = 2 * m.margin;
  float y = std::floor(m.top + 1.8f * m.margin);
  for (const auto& [label, value] : p.numbers) {
    draw.text(label, x, y, size, PlateColours::faint);
    const float right = x + inner - text_width(value, draw.font(), size);
    draw.text(value, std::floor(right), y, size, PlateColours::letters);
    y += line;
  }
}

void add_diagram(const Diagram& d, const PlateMeasure& m, FlatDraw& draw) {
  if (d.empty()) return;
  const float tall = 0.27f * m.height, wide = tall * float(d.aspect);
  const float title = d.title.empty() ? 0 : std::floor(1.3f * m.text);
  const float x0 = m.width - 2 * m.margin - wide, y0 = m.top + 1.8f * m.margin + title;
  draw.box(x0 - m.margin, m.top + m.margin, m.width - m.margin, y0 + tall + 0.6f * m.margin,
           PlateColours::ground);
  draw.text(d.title, std::floor(x0), std::floor(m.top + 1.7f * m.margin), m.text,
            PlateColours::accent);
  const auto px = [&](const Vec2& p) { return x0 + float(p.x()) * tall; };
  const auto py = [&](const Vec2& p) { return y0 + (1 - float(p.y())) * tall; };
  const float unit = m.text / 13;
  for (const Diagram::Box& b : d.boxes)
    draw.box(px(b.min), py(b.max), px(b.max), py(b.min), ink_on_plate(b.ink, b.opacity));
  for (const Diagram::Line& l : d.lines) {
    const uint32_t colour = ink_on_plate(l.ink);
    const float ax = px(l.a), ay = py(l.a), bx = px(l.b), by = py(l.b);
    draw.line(ax, ay, bx, by, l.width * unit, colour);
    const float dx = bx - ax, dy = by - ay, n = std::sqrt(dx * dx + dy * dy);
    if (!l.arrow || !(n > 0)) continue;
    const float ux = dx / n * 3 * unit, uy = dy / n * 3 * unit;
    draw.triangle(bx + ux, by + uy, bx - ux - uy, by - uy + ux, bx - ux + uy, by - uy - ux, colour);
  }
  for (const Diagram::Point& p : d.points)
    draw.disc(px(p.x), py(p.x), 0.5f * p.size * unit, ink_on_plate(p.ink));
  for (const Diagram::Label& l : d.labels) {
    const float w = text_width(l.text, draw.font(), m.text);
    const float x = px(l.x) - float(l.anchor.x()) * w;
    const float y = py(l.x) - (1 - float(l.anchor.y())) * m.text;
    const uint32_t colour = l.ink == Ink::plain ? PlateColours::letters : ink_on_plate(l.ink);
    draw.text(l.text, std::floor(x), std::floor(y), m.text, colour);
  }
}

}  // namespace

std::vector<std::string> wrapped(std::string_view text, const FontAtlas& font, float size,
                                 float width) {
  std::vector<std::string> lines;
  std::string line;
  while (!text.empty()) {
    const size_t end = std::min(text.find(' '), text.size());
    const std::string word(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    if (word.empty()) continue;
    const std::string longer = line.empty() ? word : line + " " + word;
    if (!line.empty() && text_width(longer, font, size) > width) {
      lines.push_back(std::move(line));
      line = word;
    } else {
      line = longer;
    }
  }
  if (!line.empty()) lines.push_back(std::move(line));
  return lines;
}

void add_plate(const Plate& plate, const FontAtlas& font, int width, int height, float ui_scale,
               UiDrawList& ui) {
  FlatDraw draw(ui, font);
  const PlateMeasure m = plate_measure(width, height, ui_scale, plate.top);
  add_numbers(plate, m, draw);
  add_diagram(plate.diagram, m, draw);
  add_plate_caption(plate, m, draw);
}

}  // namespace tumble
