#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/settings_form.hpp"
#include "viewer/ui/style.hpp"

#include <string>

#include <imgui.h>

namespace tumble {
namespace {

void draw_quality(PanelContext& context) {
  constexpr const char* names[] = {"automatic", "draft", "standard", "high"};
  left_label("picture");
  auto index = int(context.state.quality);
  if (ImGui::Combo("##quality", &index, names, 4)) context.state.quality = PictureQuality(index);
  context.host.mark("settings.quality");
  tooltip_with_key(context, "automatic: a draft where a better one would not be fluent", {});
}

/// Draws the numbers that the scene declares. When a slider is released, the scene is opened anew.
void draw_parameters(PanelContext& context) {
  if (!context.model.parameters || context.model.parameters->empty()) return;
  small_text(context, "scene", palette::accent);
  const auto value_of = [](const SceneParameter& p) { return p.value; };
  if (auto change = draw_numbers_form(context, "parameters", value_of)) context.ask(*change);
  ImGui::Dummy(ImVec2(0, 2));
}

}  // namespace

void draw_settings_panel(PanelContext& context) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 4));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(8, 3));
  draw_parameters(context);
  WorldSettings settings = context.model.settings;
  if (draw_settings_form(context, "settings", settings)) context.ask(ChangeSettings{settings});

  ImGui::Dummy(ImVec2(0, 2));
  small_text(context, "machine", palette::accent);
  int threads = context.model.threads;
  if (draw_threads_slider(context, "settings.threads", threads))
    context.ask(ChangeThreads{threads});
  draw_quality(context);
  ImGui::Dummy(ImVec2(0, 2));
  if (ImGui::Button("All that the scene says ...", ImVec2(-1, 0)))
    context.state.shows(PanelId::description) = true;
  context.host.mark("settings.describe");
  tooltip_with_key(context,
                   "cameras, light, materials, numbers of the scene, lesson: every value of "
                   "its file",
                   shortcut_of(Action::toggle_description));
  ImGui::PopStyleVar(2);
}

}  // namespace tumble
