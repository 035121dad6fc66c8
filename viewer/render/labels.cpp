#include "viewer/render/labels.hpp"

#include "viewer/render/flat_draw.hpp"
#include "viewer/render/marks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

/// A label with its size, and its place before any shift [px].
struct Measured {
  float x = 0, y = 0, width = 0, height = 0;

  LabelBox shifted(float dx, float dy) const {
    // Whole pixels: letters stay as sharp as they were baked.
    return {std::floor(x + dx + 0.5f), std::floor(y + dy + 0.5f), width, height};
  }
  /// Candidate offsets by increasing distance, the own position first; of two at equal distance the
  /// upper one first, since the labelled object is below.
  std::array<LabelBox, 30> places() const {
    std::array<std::pair<float, LabelBox>, 30> sorted;
    size_t n = 0;
    for (const float lines : {0.f, -0.5f, 0.5f, -1.f, 1.f, -1.5f}) {
      for (const float widths : {0.f, 0.25f, -0.25f, 0.5f, -0.5f}) {
        const float dx = widths * width, dy = lines * height;
        sorted[n++] = {dx * dx + dy * dy, shifted(dx, dy)};
      }
    }
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::array<LabelBox, 30> out;
    std::transform(sorted.begin(), sorted.end(), out.begin(),
                   [](const auto& place) { return place.second; });
    return out;
  }
};

std::optional<Measured> measure(const TextLabel& label, const FontAtlas& font, const Camera& camera,
                                int width, int height, float ui_scale) {
  if (label.text.empty() || !label.x.allFinite()) return {};
  Vec3 at = label.x.cast<double>();
  if (label.in_world) {
    at = project(camera, at, width, height);
    if (at.z() <= 0) return {};
  }
  const float size = label.size * ui_scale;
  const float w = text_width(label.text, font, size);
  const Measured m{float(at.x()) - label.anchor.x() * w, float(at.y()) - label.anchor.y() * size, w,
                   size};
  if (!m.shifted(0, 0).overlaps({0, 0, float(width), float(height)})) return {};
  return m;
}

void draw_label(const TextLabel& label, const LabelBox& box, const FontAtlas& font,
                UiDrawList& ui) {
  FlatDraw draw(ui, font);
  if (label.plate > 0) {
    const float x = std::floor(0.3f * box.height), y = std::floor(0.1f * box.height);
    draw.box(box.x - x, box.y - y, box.x + box.width + x, box.y + box.height + y,
             rgba_bytes(Vec4f(0.01f, 0.012f, 0.015f, label.plate * label.colour.w())));
  }
  if (label.shadow) {
    const uint32_t dark = rgba_bytes(Vec4f(0, 0, 0, 0.6f * label.colour.w()));
    const float d = std::max(1.f, std::floor(box.height / font.line_height));
    draw.text(label.text, box.x + d, box.y + d, box.height, dark);
  }
  draw.text(label.text, box.x, box.y, box.height, rgba_bytes(label.colour));
}

}  // namespace

bool LabelBox::overlaps(const LabelBox& other) const {
  return x < other.x + other.width && other.x < x + width && y < other.y + other.height &&
         other.y < y + height;
}

std::vector<std::optional<LabelBox>> place_labels(const std::vector<TextLabel>& labels,
                                                  const FontAtlas& font, const Camera& camera,
                                                  int width, int height, float ui_scale) {
  std::vector<std::optional<LabelBox>> boxes(labels.size());
  std::vector<LabelBox> taken;
  for (const bool in_world : {false, true}) {
    for (size_t i = 0; i < labels.size(); ++i) {
      if (labels[i].in_world != in_world) continue;
      const auto label = measure(labels[i], font, camera, width, height, ui_scale);
      if (!label) continue;
      const auto free = [&](const LabelBox& box) {
        const float space = 0.5f * box.height;  // between words
        const LabelBox wide{box.x - space, box.y, box.width + 2 * space, box.height};
        return std::none_of(taken.begin(), taken.end(),
                            [&wide](const LabelBox& other) { return wide.overlaps(other); });
      };
      const auto places = label->places();
      const auto* const place =
          in_world ? std::find_if(places.begin(), places.end(), free) : places.begin();
      if (place == places.end()) continue;
      boxes[i] = *place;
      taken.push_back(*place);
    }
  }
  return boxes;
}

void add_labels(const std::vector<TextLabel>& labels, const FontAtlas& font, const Camera& camera,
                int width, int height, float ui_scale, UiDrawList& ui) {
  const auto boxes = place_labels(labels, font, camera, width, height, ui_scale);
  for (size_t i = 0; i < labels.size(); ++i)
    if (boxes[i]) draw_label(labels[i], *boxes[i], font, ui);
}

float text_width(std::string_view text, const FontAtlas& font, float size) {
  float width = 0;
  while (!text.empty()) {
    const Glyph* g = font.find(next_codepoint(text));
    if (!g) g = font.find('?');
    if (g) width += g->advance;
  }
  return width * size / font.line_height;
}

}  // namespace tumble
