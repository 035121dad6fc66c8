#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <array>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {

void draw_energy_panel(PanelContext& context) {
  const auto& samples = context.model.history->samples();
  std::array<Curve, 4> curves;
  curves[0] = {"kinetic", palette::blue, {}};
  curves[1] = {"gravity", palette::green, {}};
  curves[2] = {"springs", palette::violet, {}};
  curves[3] = {"total", palette::accent, {}};
  std::vector<double> times;
  for (const History::Sample& s : samples) {
    times.push_back(s.time);
    curves[0].values.push_back(float(s.energies.kinetic));
    curves[1].values.push_back(float(s.energies.gravity));
    curves[2].values.push_back(float(s.energies.springs));
    curves[3].values.push_back(float(s.energies.total()));
  }
  plot(context, "energy.plot", times, curves, 124, "J");
  ImGui::Dummy(ImVec2(0, 1));
  const Energies& now = context.model.frame->stats.energies;
  const double values[] = {now.kinetic, now.gravity, now.springs, now.total()};
  if (ImGui::BeginTable("##energies", 2, ImGuiTableFlags_SizingStretchSame)) {
    for (size_t i = 0; i < curves.size(); ++i) {
      ImGui::TableNextColumn();
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float middle = at.y + 0.5f * ImGui::GetTextLineHeight() + 1;
      ImGui::GetWindowDrawList()->AddRectFilled({at.x, middle - 1.5f}, {at.x + 10, middle + 1.5f},
                                                curves[i].colour, 1);
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 16);
      small_text(context, curves[i].label, palette::dim);
      ImGui::SameLine(0, 6);
      small_text(context, quantity_text(values[i], "J"), palette::text);
    }
    ImGui::EndTable();
  }
}

}  // namespace tumble
