#include "engine/scene/build/live_parts.hpp"
#include "viewer/ui/part_form.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <limits>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// The present reading of a sensor.
std::string reading(const Frame& frame, const std::string& name) {
  if (!frame.sensors) return {};
  for (const SensorFrame& sensor : *frame.sensors) {
    if (sensor.name != name) continue;
    if (sensor.kind == SensorKind::gate)
      return fmt::format("{} forward, {} back", sensor.forward, sensor.backward);
    if (sensor.kind == SensorKind::region)
      return fmt::format("{} inside", sensor.inside.size() + sensor.particles);
    if (sensor.kind == SensorKind::radial)
      for (const SensorValue& value : sensor_values(sensor))
        if (value.name == "peak") return fmt::format("peak {:.3g}", value.value);
    return sensor.touching ? "touches" : "apart";
  }
  return {};
}

/// Draws the curve of a radial distribution function.
void draw_curve(PanelContext& context, const std::string& name) {
  if (!context.model.frame->sensors) return;
  for (const SensorFrame& sensor : *context.model.frame->sensors) {
    if (sensor.name != name || sensor.kind != SensorKind::radial) continue;
    const std::vector<float> g(sensor.shells.begin(), sensor.shells.end());
    const std::string to = fmt::format("g(r), r to {:.3g} m", sensor.range);
    ImGui::PlotLines("##radial", g.data(), int(g.size()), 0, to.c_str(), 0,
                     std::numeric_limits<float>::max(), ImVec2(-1, 6 * ImGui::GetTextLineHeight()));
    context.host.mark("parts.radial");
  }
}

void draw_list(PanelContext& context, const char* title, std::string_view key,
               const std::vector<std::string>& names) {
  if (names.empty()) return;
  section(context, title);
  ChosenPart& chosen = context.state.part;
  for (const std::string& name : names) {
    const bool lit = chosen.list == key && chosen.name == name;
    const std::string id = fmt::format("##{}.{}", key, name);
    const ImVec2 at = ImGui::GetCursorPos();
    if (ImGui::Selectable(id.c_str(), lit)) chosen = {std::string(key), name};
    context.host.mark(fmt::format("parts.{}.{}", key, name));
    const ImVec2 next = ImGui::GetCursorPos();
    ImGui::SetCursorPos(at);
    value_row(name, key == "sensors" ? reading(*context.model.frame, name) : std::string());
    ImGui::SetCursorPos(next);
  }
}

}  // namespace

void draw_parts_panel(PanelContext& context) {
  if (!context.model.parts) return;
  const SceneDescription& parts = *context.model.parts;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  draw_list(context, "Emitters", "emitters", parts.emitters.names());
  draw_list(context, "Sensors", "sensors", parts.sensors.names());
  draw_list(context, "Forces", "forces", parts.forces.names());
  draw_list(context, "Particles, cloths, nets", "particles", parts.particles.names());
  if (parts.emitters.empty() && parts.sensors.empty() && parts.forces.empty() &&
      parts.particles.empty())
    note("There are none yet: the panel Build adds some.");
  const ChosenPart& chosen = context.state.part;
  if (const auto part = find_part(parts, chosen.list, chosen.name)) {
    ImGui::Dummy(ImVec2(0, 4));
    section(context, chosen.name.c_str());
    if (ImGui::Button("Delete")) context.ask(RemovePart{chosen.name, *part});
    context.host.mark("parts.delete");
    ImGui::SameLine();
    if (ImGui::Button("All values ...")) {
      context.state.described = ScenePath{} / chosen.list / chosen.name;
      context.state.shows(PanelId::description) = true;
    }
    context.host.mark("parts.describe");
    tooltip_with_key(context, "every value of the file, and its name",
                     shortcut_of(Action::toggle_description));
    if (chosen.list == "sensors") {
      note("It begins anew with each change.");
      draw_curve(context, chosen.name);
    }
    if (chosen.list == "particles")
      note("It begins anew where particles are put or tied in another way.");
    draw_part_form(context, chosen.name, *part);
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
