#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

constexpr size_t most_lines = 400;

void draw_lines(const SavePreview& preview) {
  const float line = ImGui::GetTextLineHeightWithSpacing();
  const float height = std::min(float(preview.lines.size()), 14.0f) * line + 8;
  ImGui::BeginChild("##lines", ImVec2(0, height), false, ImGuiWindowFlags_HorizontalScrollbar);
  for (size_t i = 0; i < std::min(preview.lines.size(), most_lines); ++i) {
    const bool goes = preview.lines[i].starts_with('-');
    ImGui::PushStyleColor(ImGuiCol_Text, goes ? palette::red : palette::green);
    ImGui::TextUnformatted(preview.lines[i].c_str());
    ImGui::PopStyleColor();
  }
  ImGui::EndChild();
}

}  // namespace

void draw_save_panel(PanelContext& context) {
  const SavePreview* preview = context.model.save;
  if (!preview) return note("Looking at what was changed ...");
  std::string& file = context.state.save_file;
  if (preview->fault.empty()) {
    note("The scene as it starts, with what was changed here, goes to");
  } else {
    note("This cannot be saved:");
    note(preview->fault);
    if (!preview->only_there) return;
    note("It may be possible in another folder:");
  }
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputText("##file", &file, ImGuiInputTextFlags_EnterReturnsTrue))
    context.ask(WriteScene{file});
  context.host.mark("save.file");
  if (!context.state.save_fault.empty()) {
    wrapped("It was not saved: " + context.state.save_fault, palette::red);
    context.host.mark("save.fault");
  }
  if (!preview->warning.empty()) {
    small_text(context, preview->warning, palette::yellow);
    context.host.mark("save.warning");
  }
  if (preview->lines.empty()) note("Nothing differs from the file as it was opened.");
  draw_lines(*preview);
  for (const std::string& line : preview->left_out) small_text(context, line, palette::yellow);
  if (ImGui::Button("Write")) context.ask(WriteScene{file});
  context.host.mark("save.write");
  tooltip_with_key(context, "write the file", shortcut_of(Action::save_scene));
  ImGui::SameLine();
  if (ImGui::Button("Cancel")) context.state.shows(PanelId::save) = false;
  context.host.mark("save.cancel");
}

}  // namespace tumble
