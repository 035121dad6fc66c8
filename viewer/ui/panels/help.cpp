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
  const float width = std::max(size.x + 12, 22.0f), height = size.y + 5;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(at, {at.x + width, at.y + height}, palette::raised, 4);
  list.AddRect(at, {at.x + width, at.y + height}, palette::rgba(0xFFFFFF, 0.14f), 4);
  list.AddText({at.x + 0.5f * (width - size.x), at.y + 2}, palette::text, text.data(),
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

}  // namespace

void draw_help_panel(PanelContext& context) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 4));
  const bool table = ImGui::BeginTable("##help", 3, ImGuiTableFlags_SizingStretchSame);
  if (table) {
    // Groups in order, a new column after each third of the lines.
    ImGui::TableNextColumn();
    const float lines_per_column = float(all_bindings().size() + 12) / 2.0f;
    float lines = 0;
    int columns = 1;
    for (const std::string_view group : groups()) {
      const auto size = float(std::count_if(all_bindings().begin(), all_bindings().end(),
                                            [&](const Binding& b) { return b.group == group; }));
      if (lines > 0 && columns < 2 && lines + size > lines_per_column) {
        ImGui::TableNextColumn();
        ++columns;
        lines = 0;
      }
      draw_group(context, group);
      lines += size + 2;
    }
    ImGui::TableNextColumn();
    section(context, "Mouse");
    for (const PointerBinding& p : all_pointer_bindings()) {
      ImGui::TextUnformatted(p.gesture.data(), p.gesture.data() + p.gesture.size());
      ImGui::PushFont(context.host.fonts().small);
      ImGui::Indent(10);
      note(p.doc);
      ImGui::Unindent(10);
      ImGui::PopFont();
    }
    ImGui::EndTable();
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
