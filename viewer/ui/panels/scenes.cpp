#include "viewer/ui/fuzzy.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

bool contains(const std::string& text, const std::string& part) {
  const auto same = [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

std::vector<const SceneItem*> matching(const UiModel& model, const std::string& search) {
  struct Hit {
    const SceneItem* item;
    int score;
  };
  std::vector<Hit> hits;
  for (const SceneItem& item : *model.scenes) {
    const auto by_name = fuzzy_score(search, item.name);
    // Letters in order are found in any sentence: there the words must stand as they are.
    if (!by_name && !contains(item.doc, search)) continue;
    hits.push_back({&item, by_name.value_or(-1000)});
  }
  std::stable_sort(hits.begin(), hits.end(),
                   [](const Hit& a, const Hit& b) { return a.score > b.score; });
  std::vector<const SceneItem*> out;
  for (const Hit& hit : hits) out.push_back(hit.item);
  return out;
}

bool draw_item(PanelContext& context, const SceneItem& item, bool chosen) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = 42;
  const bool clicked =
      ImGui::InvisibleButton(fmt::format("##{}", item.name).c_str(), ImVec2(width, height));
  context.host.mark(fmt::format("scenes.{}", item.name));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (chosen || ImGui::IsItemHovered())
    list.AddRectFilled(at, {at.x + width, at.y + height},
                       chosen ? palette::accent_soft : palette::raised, 6);
  const bool current = item.name == context.model.scene_name;
  list.AddText({at.x + 12, at.y + 4}, current ? palette::accent : palette::text, item.name.c_str());
  const UiFonts& fonts = context.host.fonts();
  ImGui::PushFont(fonts.small);
  const std::string doc = shortened(item.doc, width - 24);
  list.AddText({at.x + 12, at.y + 22}, palette::dim, doc.c_str());
  ImGui::PopFont();
  return clicked;
}

}  // namespace

void draw_scenes_panel(PanelContext& context) {
  UiState& state = context.state;
  if (state.search_opened || state.search_focus) ImGui::SetKeyboardFocusHere();
  if (state.search_opened) {
    state.search_opened = false;
    state.search.clear();
    state.search_cursor = 0;
  }
  ImGui::SetNextItemWidth(-1);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(12, 8));
  if (ImGui::InputTextWithHint("##search", "type a part of the name", &state.search))
    state.search_cursor = 0;
  ImGui::PopStyleVar();
  context.host.mark("scenes.search");
  const std::vector<const SceneItem*> items = matching(context.model, state.search);
  const int count = int(items.size());
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_DownArrow))) ++state.search_cursor;
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_UpArrow))) --state.search_cursor;
  state.search_cursor = std::clamp(state.search_cursor, 0, std::max(count - 1, 0));
  const bool enter = ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
  const auto open = [&](const SceneItem& item) {
    context.ask(OpenScene{item.name});
    state.shows(PanelId::scenes) = false;
    context.host.give_up_keys();
  };
  ImGui::Dummy(ImVec2(0, 2));
  if (items.empty())
    note(context.model.scenes->empty() ? "There are no scenes here." : "No scene has such a name.");
  // The list scrolls and not the panel around it, also in a low window.
  const float room = std::clamp(ImGui::GetIO().DisplaySize.y - 220, 88.0f, 400.0f);
  const float list_height = std::min(float(count) * 44.0f, room);
  if (count == 0) return;
  ImGui::BeginChild("##list", ImVec2(0, list_height));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 2));
  for (int i = 0; i < count; ++i) {
    const bool chosen = i == state.search_cursor;
    if (draw_item(context, *items[size_t(i)], chosen)) open(*items[size_t(i)]);
    if (chosen && !ImGui::IsItemVisible()) ImGui::SetScrollHereY();
  }
  ImGui::PopStyleVar();
  ImGui::EndChild();
  if (enter) open(*items[size_t(state.search_cursor)]);
  small_text(context, "A scene, robot or mesh file dropped on the window opens too.",
             palette::faint);
}

}  // namespace tumble
