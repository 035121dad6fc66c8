#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

void key_cap(PanelContext& context, std::string_view text) {
  ImGui::PushFont(context.host.fonts().small);
  const ImVec2 size = ImGui::CalcTextSize(text.data(), text.data() + text.size());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = std::max(size.x + 12, 22.0f), height = size.y + 2;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, palette::raised, 4);
  list.AddRect(at, {at.x + width, at.y + height}, palette::faded(palette::text, 0.14f), 4);
  list.AddText({at.x + 0.5f * (width - size.x), at.y + 1}, palette::text, text.data(),
               text.data() + text.size());
  ImGui::Dummy(ImVec2(width, height));
  ImGui::PopFont();
}

/// One line per action: chords, then what they do.
void draw_group(PanelContext& context, std::string_view group) {
  section(context, std::string(group).c_str());
  std::vector<Action> done;
  const float doc_at = ImGui::GetCursorPosX() + 102;
  for (const Binding& b : all_bindings()) {
    if (b.group != group || std::find(done.begin(), done.end(), b.action) != done.end()) continue;
    done.push_back(b.action);
    for (const Binding& same : all_bindings())
      if (same.action == b.action) {
        key_cap(context, chord_text(same));
        ImGui::SameLine(0, 4);
      }
    // Several chords take a line of their own.
    if (ImGui::GetCursorPosX() > doc_at) ImGui::NewLine();
    ImGui::SetCursorPosX(doc_at);
    note(b.doc);
    context.host.mark(fmt::format("help.{}", chord_text(b)));
  }
}

std::vector<std::string_view> groups() {
  std::vector<std::string_view> out;
  for (const Binding& b : all_bindings())
    if (std::find(out.begin(), out.end(), b.group) == out.end()) out.push_back(b.group);
  return out;
}

/// Distributes groups of lines over columns in order, so that the longest column is as short as
/// possible.
std::vector<int> spread(const std::vector<int>& lines, int columns) {
  std::vector<int> column_of(lines.size());
  for (int limit = *std::max_element(lines.begin(), lines.end());; ++limit) {
    int column = 0, filled = 0;
    for (size_t i = 0; i < lines.size(); ++i) {
      if (filled + lines[i] > limit) {
        ++column;
        filled = 0;
      }
      filled += lines[i];
      column_of[i] = column;
    }
    if (column < columns) return column_of;
  }
}

void draw_mouse(PanelContext& context) {
  section(context, "Mouse");
  for (const PointerBinding& p : all_pointer_bindings()) {
    ImGui::TextUnformatted(p.gesture.data(), p.gesture.data() + p.gesture.size());
    ImGui::PushFont(context.host.fonts().small);
    ImGui::Indent(10);
    note(p.doc);
    ImGui::Unindent(10);
    ImGui::PopFont();
  }
}

}  // namespace

void draw_help_panel(PanelContext& context) {
  constexpr float least_column = 225;
  const float width = ImGui::GetContentRegionAvail().x;
  const int columns = std::clamp(int(width / least_column), 1, 5);
  // Groups in order; the mouse and its notes come last.
  const std::vector<std::string_view> keys = groups();
  const auto lines_of = [](std::string_view group) {
    return 2 + int(std::count_if(all_bindings().begin(), all_bindings().end(),
                                 [&](const Binding& b) { return b.group == group; }));
  };
  std::vector<int> lines;
  for (const std::string_view group : keys) lines.push_back(lines_of(group));
  lines.push_back(1 + int(3 * all_pointer_bindings().size() / 2));
  const std::vector<int> column_of = spread(lines, columns);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 1));
  if (ImGui::BeginTable("##help", columns, ImGuiTableFlags_SizingStretchSame)) {
    ImGui::TableNextColumn();
    for (size_t i = 0; i < lines.size(); ++i) {
      if (i > 0 && column_of[i] != column_of[i - 1]) ImGui::TableNextColumn();
      i < keys.size() ? draw_group(context, keys[i]) : draw_mouse(context);
    }
    ImGui::EndTable();
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
