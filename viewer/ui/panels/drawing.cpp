#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// Label of an overlay's switch, and the key that toggles it.
struct Label {
  std::string_view overlay;
  const char* text;
  std::optional<Action> action;
};
constexpr Label labels[] = {
    {"contacts", "Contacts", Action::overlay_contacts},
    {"normals", "Normals", Action::overlay_normals},
    {"forces", "Contact forces", Action::overlay_forces},
    {"friction_cones", "Friction cones", Action::overlay_friction},
    {"aabbs", "Bounds", Action::overlay_bounds},
    {"joints", "Joints and springs", Action::overlay_joints},
    {"grid", "Broad phase", Action::overlay_grid},
    {"collision_shape", "Collision shapes", Action::overlay_collision_shape},
    {"sensors", "Sensors", std::nullopt},
    {"hierarchy", "Hierarchy", Action::overlay_hierarchy},
    {"velocities", "Velocities", Action::overlay_velocities},
    {"momenta", "Momenta", Action::overlay_momenta},
    {"total_forces", "Total forces", Action::overlay_total_forces},
    {"islands", "Islands and sleep", std::nullopt},
};

/// Choice of kind and level of the hierarchy shown.
void draw_hierarchy_choice(PanelContext& context) {
  Overlays& overlays = context.state.overlays;
  ImGui::Indent(40);
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::SetNextItemWidth(width);
  const std::string of_scene = "as the scene: " + context.model.settings.hierarchy;
  const std::string& shown = overlays.hierarchy_kind.empty() ? of_scene : overlays.hierarchy_kind;
  if (ImGui::BeginCombo("##hierarchy_kind", shown.c_str())) {
    if (ImGui::Selectable(of_scene.c_str(), overlays.hierarchy_kind.empty()))
      overlays.hierarchy_kind.clear();
    for (const std::string& name : drawn_hierarchies()) {
      if (ImGui::Selectable(name.c_str(), name == overlays.hierarchy_kind))
        overlays.hierarchy_kind = name;
      context.host.mark("drawing.hierarchy." + name);
    }
    ImGui::EndCombo();
  }
  context.host.mark("drawing.hierarchy_kind");
  ImGui::SetNextItemWidth(width);
  ImGui::SliderInt("##hierarchy_level", &overlays.hierarchy_level, 0, 24, "level %d",
                   ImGuiSliderFlags_AlwaysClamp);
  context.host.mark("drawing.hierarchy_level");
  tooltip_with_key(context, "0 is the volume around everything; each level halves it",
                   shortcut_of(Action::overlay_hierarchy));
  ImGui::Unindent(40);
}

/// Choice of the length of arrows; the legend gives their scale.
void draw_vector_length(PanelContext& context) {
  constexpr double least = 0.02, most = 50;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  ImGui::SliderScalar("##vector_length", ImGuiDataType_Double,
                      &context.state.overlays.vector_length, &least, &most, "arrows x %.2g",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  context.host.mark("drawing.vector_length");
  tooltip_with_key(context, "length of arrows of velocity, momentum and total force", {});
}

/// A switch for the paths of moving bodies, and their length.
void draw_trails(PanelContext& context) {
  constexpr double usual = 2, least = 0.1, most = 60;  // [s]
  double seconds = context.model.trail;
  bool on = seconds > 0;
  if (toggle(context, "drawing.trails", "Trails", on)) context.state.trail = on ? usual : 0;
  tooltip_with_key(context, "the way that each moving body goes from now on", {});
  if (!on || seconds == 0) return;
  // Trails of another length begin anew: not before the slider is let go.
  auto& pulled = context.state.pulled_parameters;
  const std::string name = "drawing.trail_length";
  if (pulled.contains(name)) seconds = pulled[name];
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  ImGui::SliderScalar("##trail", ImGuiDataType_Double, &seconds, &least, &most, "the last %.2g s",
                      ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  context.host.mark(name);
  if (ImGui::IsItemActive()) pulled[name] = seconds;
  if (!ImGui::IsItemDeactivated()) return;
  pulled.erase(name);
  if (ImGui::IsItemDeactivatedAfterEdit()) context.state.trail = seconds;
}

/// Theme and size of the panels themselves.
void draw_appearance(PanelContext& context) {
  UiState& state = context.state;
  for (const Theme theme : {Theme::dark, Theme::light}) {
    const char* text = theme == Theme::dark ? "Dark" : "Light";
    if (word_button(context, fmt::format("drawing.{}", theme_names[size_t(theme)]), text,
                    state.theme == theme, "colours of the panels", shortcut_of(Action::next_theme)))
      state.theme = theme;
    ImGui::SameLine(0, 2);
  }
  ImGui::SameLine(ImGui::GetContentRegionMax().x - 108);
  if (word_button(context, "drawing.smaller", "–", false, "smaller panels and text",
                  shortcut_of(Action::smaller)))
    context.ask(Action::smaller);
  ImGui::SameLine(0, 4);
  ImGui::AlignTextToFramePadding();
  ImGui::Text("%3.0f %%", 100 * state.zoom);
  ImGui::SameLine(0, 4);
  if (word_button(context, "drawing.larger", "+", false, "larger panels and text",
                  shortcut_of(Action::larger)))
    context.ask(Action::larger);
}

}  // namespace

void draw_drawing_panel(PanelContext& context) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  for (const OverlayEntry& entry : all_overlays()) {
    std::string text(entry.name), key;
    for (const Label& label : labels)
      if (label.overlay == entry.name) {
        text = label.text;
        if (label.action) key = shortcut_of(*label.action);
      }
    toggle(context, fmt::format("drawing.{}", entry.name), text.c_str(),
           context.state.overlays.*entry.enabled, key);
    tooltip_with_key(context, entry.doc, key);
    if (entry.enabled == &Overlays::hierarchy && context.state.overlays.hierarchy)
      draw_hierarchy_choice(context);
    const Overlays& shown = context.state.overlays;
    if (entry.enabled == &Overlays::total_forces &&
        (shown.velocities || shown.momenta || shown.total_forces))
      draw_vector_length(context);
  }
  draw_trails(context);
  ImGui::PopStyleVar();
  section(context, "Panels");
  draw_appearance(context);
}

}  // namespace tumble
