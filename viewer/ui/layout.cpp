#include "viewer/ui/layout.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr float bar_height = 46, margin = 10, gap = 8;
constexpr float left_width = 292, right_width = 296;
constexpr float least_height = 60;

float wish(const PanelEntry& panel, const UiState& state) {
  const float measured = state.content_height[size_t(panel.id)];
  return measured > 0 ? measured : panel.usual_height;
}

bool place_column(UiLayout& out, const UiState& state, Dock dock, float x, float width, float y,
                  float height) {
  std::vector<const PanelEntry*> column;
  std::vector<float> wishes;
  for (const PanelEntry& panel : all_panels())
    if (panel.dock == dock && state.shows(panel.id)) {
      column.push_back(&panel);
      wishes.push_back(wish(panel, state));
    }
  const float gaps = gap * float(column.empty() ? 0 : column.size() - 1);
  const std::vector<float> heights = share_height(wishes, height - gaps);
  for (size_t i = 0; i < column.size(); ++i) {
    out.panels.push_back({column[i], {x, y, width, heights[i]}});
    y += heights[i] + gap;
  }
  return !column.empty();
}

UiRect centred(const PanelEntry& panel, const UiState& state, float width, float height) {
  const float w = std::min(panel.id == PanelId::help ? 780.0f : 560.0f, width - 2 * margin);
  const float space = height - bar_height - 2 * margin;
  const float h = std::min(wish(panel, state), space);
  // A list to choose from stays where it is while it shrinks; a page to read stands in the middle.
  const float y = panel.id == PanelId::scenes ? bar_height + margin + 0.06f * space
                                              : bar_height + margin + 0.4f * (space - h);
  return {0.5f * (width - w), std::min(y, height - margin - h), w, h};
}

}  // namespace

std::vector<float> share_height(const std::vector<float>& wishes, float available) {
  std::vector<float> sorted = wishes;
  std::sort(sorted.begin(), sorted.end());
  float left = std::max(available, 0.0f), limit = 0;
  for (size_t i = 0; i < sorted.size(); ++i) {
    limit = left / float(sorted.size() - i);
    if (sorted[i] > limit) break;
    left -= sorted[i];
    limit = sorted[i];
  }
  std::vector<float> out;
  for (const float w : wishes) out.push_back(std::min(w, limit));
  return out;
}

UiLayout layout_ui(double width_d, double height_d, const UiState& state) {
  const auto width = float(width_d), height = float(height_d);
  UiLayout out;
  out.top_bar = {0, 0, width, bar_height};
  const float y = bar_height + margin, space = std::max(height - y - margin, least_height);
  const bool left =
      place_column(out, state, Dock::left, margin, std::min(left_width, 0.4f * width), y, space);
  const float right_w = std::min(right_width, 0.45f * width);
  const bool right =
      place_column(out, state, Dock::right, width - margin - right_w, right_w, y, space);
  const float x0 = left ? margin + left_width + gap : margin;
  const float x1 = right ? width - margin - right_w - gap : width - margin;
  out.free_area = {x0, y, std::max(x1 - x0, 1.0f), space};
  for (const PanelEntry& panel : all_panels())
    if (panel.dock == Dock::centre && state.shows(panel.id))
      out.panels.push_back({&panel, centred(panel, state, width, height)});
  return out;
}

}  // namespace tumble
