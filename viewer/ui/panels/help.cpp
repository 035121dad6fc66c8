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
  const int columns = std::clamp(int(width / least_column), 1, 3);
  // Groups in order, a new column after each share of the lines; the mouse, of small print, is one.
  const std::vector<std::string_view> keys = groups();
  const auto lines_of = [](std::string_view group) {
    return 2 + int(std::count_if(all_bindings().begin(), all_bindings().end(),
                                 [&](const Binding& b) { return b.group == group; }));
  };
  const int of_mouse = 1 + int(3 * all_pointer_bindings().size() / 2);
  int total = of_mouse;
  for (const std::string_view group : keys) total += lines_of(group);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 4));
  if (ImGui::BeginTable("##help", columns, ImGuiTableFlags_SizingStretchSame)) {
    ImGui::TableNextColumn();
    int lines = 0, column = 1;
    const auto make_room = [&](int more) {
      // Half a group over the share is better than a column that ends too early.
      if (lines > 0 && column < columns && lines + more / 2 > total / columns) {
        ImGui::TableNextColumn();
        ++column;
        lines = 0;
      }
      lines += more;
    };
    for (const std::string_view group : keys) {
      make_room(lines_of(group));
      draw_group(context, group);
    }
    make_room(of_mouse);
    draw_mouse(context);
    ImGui::EndTable();
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
