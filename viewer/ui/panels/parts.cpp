#include "engine/scene/build/live_parts.hpp"
#include "viewer/ui/part_form.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// What a sensor says at this moment, beside its name.
std::string reading(const Frame& frame, const std::string& name) {
  if (!frame.sensors) return {};
  for (const SensorFrame& sensor : *frame.sensors) {
    if (sensor.name != name) continue;
    if (sensor.kind == SensorKind::gate)
      return fmt::format("{} forward, {} back", sensor.forward, sensor.backward);
    if (sensor.kind == SensorKind::region)
      return fmt::format("{} inside", sensor.inside.size() + sensor.particles);
    return sensor.touching ? "touches" : "apart";
  }
  return {};
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
    if (chosen.list == "sensors") note("It begins anew with each change.");
    if (chosen.list == "particles")
      note("It begins anew where particles are put or tied in another way.");
    draw_part_form(context, chosen.name, *part);
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
