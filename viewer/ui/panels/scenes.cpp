#include "engine/scene/mesh_files/formats.hpp"
#include "viewer/ui/fuzzy.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>

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

std::vector<const SceneItem*> matching(const UiModel& model, const std::string& search,
                                       const std::string& category) {
  struct Hit {
    const SceneItem* item;
    int score;
  };
  std::vector<Hit> hits;
  for (const SceneItem& item : *model.scenes) {
    // A search covers all categories.
    if (search.empty() && !category.empty() && item.category != category) continue;
    const auto by_name = fuzzy_score(search, item.name);
    const auto by_title = fuzzy_score(search, item.title);
    // Fuzzy matching would find some match in almost any sentence, so descriptions must contain the
    // search literally.
    if (!by_name && !by_title && !contains(item.doc, search)) continue;
    constexpr int by_doc = -1000;
    hits.push_back({&item, std::max(by_name.value_or(by_doc), by_title.value_or(by_doc))});
  }
  std::stable_sort(hits.begin(), hits.end(),
                   [](const Hit& a, const Hit& b) { return a.score > b.score; });
  std::vector<const SceneItem*> out;
  for (const Hit& hit : hits) out.push_back(hit.item);
  return out;
}

constexpr float picture_width = 96, picture_height = 54, item_height = 62;

/// Draws the thumbnail of a scene, or an empty frame.
void draw_picture(PanelContext& context, const SceneItem& item, ImVec2 at) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + picture_width, at.y + picture_height);
  list.AddRectFilled(at, end, palette::well, 4);
  const auto* all = context.model.thumbnails;
  if (!all) return;
  if (const auto found = all->find(item.name); found != all->end())
    list.AddImageRounded(reinterpret_cast<ImTextureID>(uintptr_t(found->second)), at, end, {0, 0},
                         {1, 1}, IM_COL32_WHITE, 4);
}

bool draw_item(PanelContext& context, const SceneItem& item, bool chosen) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  const bool clicked =
      ImGui::InvisibleButton(fmt::format("##{}", item.name).c_str(), ImVec2(width, item_height));
  if (!ImGui::IsItemVisible()) return clicked;
  context.state.seen_scenes.push_back(item.name);
  context.host.mark(fmt::format("scenes.{}", item.name));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (chosen || ImGui::IsItemHovered())
    list.AddRectFilled(at, {at.x + width, at.y + item_height},
                       chosen ? palette::accent_soft : palette::raised, 6);
  draw_picture(context, item, {at.x + 4, at.y + 4});
  const bool current = item.name == context.model.scene_name;
  const float x = at.x + picture_width + 16;
  const float room = width - picture_width - 24;
  const std::string title = shortened(item.title.empty() ? item.name : item.title, room);
  list.AddText({x, at.y + 6}, current ? palette::accent : palette::text, title.c_str());
  const float title_end = x + ImGui::CalcTextSize(title.c_str()).x + 10;
  ImGui::PushFont(context.host.fonts().small);
  // The name is shown because the command line takes it.
  const float name_width = ImGui::CalcTextSize(item.name.c_str()).x;
  if (!item.title.empty() && title_end + name_width < x + room)
    list.AddText({x + room - name_width, at.y + 8}, palette::faint, item.name.c_str());
  const std::string doc = shortened(item.doc, 1.85f * room);  // two lines
  list.AddText(nullptr, 0, {x, at.y + 25}, palette::dim, doc.c_str(), nullptr, room);
  ImGui::PopFont();
  return clicked;
}

/// Draws a word for each category, and one for all; a click narrows the list.
void draw_categories(PanelContext& context) {
  std::vector<std::string> all = {""};
  for (const SceneItem& item : *context.model.scenes)
    if (!item.category.empty() && std::find(all.begin(), all.end(), item.category) == all.end())
      all.push_back(item.category);
  if (all.size() == 1) return;
  std::sort(all.begin() + 1, all.end());
  const float right = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x;
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(7, 2));
  for (const std::string& category : all) {
    const char* text = category.empty() ? "all" : category.c_str();
    const float width = ImGui::CalcTextSize(text).x + 14;
    if (!category.empty()) {
      ImGui::SameLine(0, 2);
      if (ImGui::GetCursorScreenPos().x + width > right) ImGui::NewLine();
    }
    const bool lit = category == context.state.category;
    ImGui::PushStyleColor(ImGuiCol_Button, lit ? palette::accent_soft : palette::raised);
    ImGui::PushStyleColor(ImGuiCol_Text, lit ? palette::accent : palette::dim);
    if (ImGui::Button(text)) {
      context.state.category = category;
      context.state.search_cursor = 0;
    }
    ImGui::PopStyleColor(2);
    std::string name = text;  // one word, for scripts
    std::replace(name.begin(), name.end(), ' ', '_');
    context.host.mark("scenes.category." + name);
  }
  ImGui::PopStyleVar();
}

float list_room() {
  return std::clamp(ImGui::GetIO().DisplaySize.y - 310, 88.0f, 440.0f);
}

void take_into_palette(UiState& state, const std::string& path) {
  state.build.mesh_file = path;
  state.build.what = NewMesh{path, state.build.mesh_mode};
  state.building = true;
  state.choosing_mesh = false;
  state.handles.kind = HandleKind::none;
}

void draw_files(PanelContext& context, const FolderView& folder) {
  if (context.state.choosing_mesh) {
    ImGui::AlignTextToFramePadding();
    note("From");
  } else {
    if (ImGui::Button("To the scenes")) context.ask(BrowseFolder{});
    context.host.mark("scenes.to_scenes");
  }
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  small_text(context, shortened(folder.path, ImGui::GetContentRegionAvail().x), palette::dim);
  ImGui::BeginChild("##files", ImVec2(0, list_room()));
  const std::filesystem::path here(folder.path);
  if (here.has_relative_path() && ImGui::Selectable(".. (up)"))
    context.ask(BrowseFolder{here.parent_path().string()});
  context.host.mark("scenes.up");
  for (const FolderView::Entry& entry : folder.entries) {
    if (context.state.choosing_mesh && !entry.folder && !mesh_format_of(entry.name)) continue;
    const std::string path = (here / entry.name).string();
    const std::string text = entry.folder ? entry.name + "/" : entry.name;
    ImGui::PushStyleColor(ImGuiCol_Text, entry.folder ? palette::accent : palette::text);
    const bool clicked = ImGui::Selectable(text.c_str());
    ImGui::PopStyleColor();
    context.host.mark("scenes.file." + entry.name);
    if (clicked && entry.folder) context.ask(BrowseFolder{path});
    if (!clicked || entry.folder) continue;
    if (context.state.choosing_mesh)
      take_into_palette(context.state, path);
    else
      context.ask(OpenScene{path});
    context.state.shows(PanelId::scenes) = false;
    context.host.give_up_keys();
  }
  if (!folder.fault.empty()) note("This folder cannot be read: " + folder.fault);
  if (folder.entries.empty() && folder.fault.empty())
    note(context.state.choosing_mesh ? "No folders here, and no meshes."
                                     : "No folders here, and no scenes, packs, robots or meshes.");
  ImGui::EndChild();
}

}  // namespace

void draw_scenes_panel(PanelContext& context) {
  UiState& state = context.state;
  state.seen_scenes.clear();
  if (context.model.folder) return draw_files(context, *context.model.folder);
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
  draw_categories(context);
  const std::vector<const SceneItem*> items = matching(context.model, state.search, state.category);
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
  // The list scrolls, not the panel around it, even in a low window.
  const float list_height = std::min(float(count) * (item_height + 2), list_room());
  ImGui::BeginChild("##list", ImVec2(0, std::max(list_height, 1.0f)));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 2));
  for (int i = 0; i < count; ++i) {
    const bool chosen = i == state.search_cursor;
    if (draw_item(context, *items[size_t(i)], chosen)) open(*items[size_t(i)]);
    if (chosen && !ImGui::IsItemVisible()) ImGui::SetScrollHereY();
  }
  ImGui::PopStyleVar();
  ImGui::EndChild();
  if (enter && count > 0) open(*items[size_t(state.search_cursor)]);
  if (ImGui::Button("Files ...")) context.ask(BrowseFolder{context.model.start_folder});
  context.host.mark("scenes.files");
  ImGui::SameLine();
  ImGui::AlignTextToFramePadding();
  small_text(context, "A scene, pack, robot or mesh file dropped on the window opens too.",
             palette::faint);
}

}  // namespace tumble
