#include "viewer/ui/layout.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr float bar_height = 46, margin = 10, gap = 8;
constexpr float left_width = 292, right_width = 296;
constexpr float least_height = 60;
constexpr float least_open = 120, folded_height = 42;
/// A page of a lesson with its question is read without scrolling in the first of these heights; in
/// the second a paragraph is. For it other panels fold.
constexpr float readable_lesson = 400, least_lesson = 220;
/// Least width of the picture for two columns; below, they would leave too little of the scene.
constexpr float two_columns = left_width + right_width + 2 * margin + 2 * gap + 140;

float preferred_height(const PanelEntry& panel, const UiState& state) {
  const float measured = state.content_height[size_t(panel.id)];
  return measured > 0 ? measured : panel.usual_height;
}

struct Docked {
  const PanelEntry* panel;
  float preferred_height;
  uint32_t raised;
  enum class Form : uint8_t { open, folded, out } form = Form::open;

  bool is_lesson() const { return panel->id == PanelId::lesson; }
  /// `lesson`: the least height of a lesson.
  float least(float lesson = least_lesson) const {
    return form == Form::open     ? std::min(preferred_height, is_lesson() ? lesson : least_open)
           : form == Form::folded ? folded_height
                                  : -gap;
  }
};

float least_of(const std::vector<Docked>& column, float lesson = least_lesson) {
  float sum = -gap;
  for (const Docked& m : column) sum += m.least(lesson) + gap;
  return sum;
}

/// Leaves out panels that have nothing to show, then folds, and then leaves out others until the
/// rest fits; what was raised last stays open, and so does a lesson as long as others can fold.
void make_fit(std::vector<Docked>& column, float height, const UiState& state) {
  float wanted = -gap;
  for (const Docked& m : column) wanted += m.preferred_height + gap;
  if (wanted > height && column.size() > 1)
    std::erase_if(column, [&](const Docked& m) { return state.idle[size_t(m.panel->id)]; });
  std::vector<Docked*> oldest_first;
  for (Docked& m : column) oldest_first.push_back(&m);
  std::stable_sort(oldest_first.begin(), oldest_first.end(),
                   [](const Docked* a, const Docked* b) { return a->raised < b->raised; });
  if (!oldest_first.empty()) oldest_first.pop_back();
  const bool taught =
      std::any_of(column.begin(), column.end(), [](const Docked& m) { return m.is_lesson(); });
  for (Docked* m : oldest_first) {
    if (!taught || least_of(column, readable_lesson) <= height) break;
    if (!m->is_lesson()) m->form = Docked::Form::folded;
  }
  for (const Docked::Form form : {Docked::Form::folded, Docked::Form::out})
    for (Docked* m : oldest_first) {
      if (least_of(column) <= height) return;
      m->form = form;
    }
}

/// A lesson is read in one piece where the others keep enough to be used; the rest is shared.
std::vector<float> share_with_first(const std::vector<Docked>& column,
                                    const std::vector<float>& preferred, float available) {
  const bool taught =
      !column.empty() && column.front().is_lesson() && column.front().form == Docked::Form::open;
  if (!taught) return share_height(preferred, available);
  constexpr float least_beside = 2 * least_open;  // for each other panel that needs as much
  float kept = 0, kept_at_least = 0;
  for (size_t i = 1; i < preferred.size(); ++i) {
    kept += std::min(preferred[i], least_beside);
    kept_at_least += std::min(preferred[i], least_open);
  }
  const float least = std::min(readable_lesson, available - kept_at_least);
  const float lesson = std::min(preferred.front(), std::max({available - kept, least, least_open}));
  std::vector<float> out =
      share_height({preferred.begin() + 1, preferred.end()}, available - lesson);
  out.insert(out.begin(), std::min(lesson, available));
  return out;
}

void place_column(UiLayout& out, std::vector<Docked>& column, const UiRect& r,
                  const UiState& state) {
  make_fit(column, r.height, state);
  std::vector<float> preferred;
  for (const Docked& m : column)
    if (m.form == Docked::Form::open) preferred.push_back(m.preferred_height);
  const float others = least_of(column) - [&] {
    float sum = 0;
    for (const Docked& m : column)
      if (m.form == Docked::Form::open) sum += m.least();
    return sum;
  }();
  const std::vector<float> heights = share_with_first(column, preferred, r.height - others);
  auto height = heights.begin();
  float y = r.y;
  for (const Docked& m : column) {
    if (m.form == Docked::Form::out) continue;
    const bool folded = m.form == Docked::Form::folded;
    const float h = folded ? folded_height : *height++;
    out.panels.push_back({m.panel, {r.x, y, r.width, h}, folded});
    y += h + gap;
  }
}

std::vector<Docked> shown_at(Dock dock, const UiState& state) {
  std::vector<Docked> out;
  for (const PanelEntry& panel : all_panels())
    if (panel.dock == dock && state.shows(panel.id) &&
        !(state.beside && state.idle[size_t(panel.id)]))
      out.push_back({&panel, preferred_height(panel, state), state.raised[size_t(panel.id)]});
  // A lesson comes first, with its plots below it.
  std::stable_partition(out.begin(), out.end(),
                        [](const Docked& m) { return m.panel->id == PanelId::lesson; });
  return out;
}

UiRect centred(const PanelEntry& panel, const UiState& state, float width, float height) {
  const float w = std::min(panel.id == PanelId::help ? 1200.0f : 560.0f, width - 2 * margin);
  const float space = height - bar_height - 2 * margin;
  const float top = bar_height + margin;
  const float h = std::min(preferred_height(panel, state), space);
  if (panel.id != PanelId::scenes) return {0.5f * (width - w), top + 0.4f * (space - h), w, h};
  // A list keeps its top edge while it shrinks; a page of text is centred.
  const float above = 0.06f * space;
  return {0.5f * (width - w), top + above, w, std::min(h, space - above)};
}

}  // namespace

bool has_two_columns(double width) {
  return width >= double(two_columns);
}

std::vector<float> share_height(const std::vector<float>& preferred, float available) {
  std::vector<float> sorted = preferred;
  std::sort(sorted.begin(), sorted.end());
  float left = std::max(available, 0.0f), limit = 0;
  for (size_t i = 0; i < sorted.size(); ++i) {
    limit = left / float(sorted.size() - i);
    if (sorted[i] > limit) break;
    left -= sorted[i];
    limit = sorted[i];
  }
  std::vector<float> out;
  for (const float w : preferred) out.push_back(std::min(w, limit));
  return out;
}

UiLayout layout_ui(double width_d, double height_d, const UiState& state) {
  const auto width = float(width_d), height = float(height_d);
  UiLayout out;
  out.top_bar = {0, 0, width, bar_height};
  const float y = bar_height + margin, space = std::max(height - y - margin, least_height);
  std::vector<Docked> left = shown_at(Dock::left, state), right = shown_at(Dock::right, state);
  if (!has_two_columns(width_d)) {
    right.insert(right.begin(), left.begin(), left.end());
    left.clear();
  }
  const float left_w = std::min(left_width, width - 2 * margin);
  const float right_w = std::min(right_width, width - 2 * margin);
  place_column(out, left, {margin, y, left_w, space}, state);
  place_column(out, right, {width - margin - right_w, y, right_w, space}, state);
  const float x0 = left.empty() ? margin : margin + left_w + gap;
  const float x1 = right.empty() ? width - margin : width - margin - right_w - gap;
  out.free_area = {x0, y, std::max(x1 - x0, 1.0f), space};
  for (const PanelEntry& panel : all_panels())
    if (panel.dock == Dock::centre && state.shows(panel.id))
      out.panels.push_back({&panel, centred(panel, state, width, height)});
  return out;
}

}  // namespace tumble
