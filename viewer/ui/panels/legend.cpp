#include "viewer/render/marks.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <imgui.h>

namespace tumble {

/// Draws the meaning of the colours of the overlays that are on, at the lower left of the scene.
void draw_legend(PanelContext& context, const UiRect& area) {
  std::vector<LegendLine> lines;
  for (const OverlayEntry& entry : all_overlays())
    for (const LegendLine& line : entry.legend)
      if (context.state.overlays.*entry.enabled &&
          (!line.there || line.there(*context.model.frame)))
        lines.push_back(line);
  constexpr float least_width = 260, least_height = 200;
  if (lines.empty() || area.width < least_width || area.height < least_height) return;
  ImGui::SetNextWindowPos(ImVec2(area.x + 10, area.y + area.height - 10), ImGuiCond_Always,
                          ImVec2(0.0f, 1.0f));
  ImGui::SetNextWindowBgAlpha(0.6f);
  ImGui::Begin("##legend", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs |
                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_AlwaysAutoResize);
  ImGui::PushFont(context.host.fonts().small);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  for (const LegendLine& line : lines) {
    const float height = ImGui::GetTextLineHeight(), width = 14;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float middle = at.y + 0.5f * height;
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, middle - 3}, {at.x + width, middle + 3},
                                              rgba_bytes(line.colour), 2);
    ImGui::Dummy(ImVec2(width, height));
    ImGui::SameLine();
    ImGui::TextUnformatted(line.text.data(), line.text.data() + line.text.size());
    if (!line.scale) continue;
    ImGui::SameLine(0, 0);
    const std::string scale = line.scale(*context.model.frame, context.state.overlays);
    ImGui::Text(": %s", scale.c_str());
  }
  ImGui::PopStyleVar();
  ImGui::PopFont();
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  context.host.mark("legend", {at.x, at.y, size.x, size.y});
  ImGui::End();
}

}  // namespace tumble
