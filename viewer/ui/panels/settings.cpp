#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/settings_form.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <imgui.h>

namespace tumble {
namespace {

/// A label at the left; the widget that follows takes the rest of the line.
void left_label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + width * 0.56f);
  ImGui::SetNextItemWidth(width * 0.44f);
}

void draw_threads(PanelContext& context) {
  int threads = context.model.threads;
  const int most = std::max(1, int(std::thread::hardware_concurrency()));
  left_label("threads");
  if (ImGui::SliderInt("##threads", &threads, 0, most, threads == 0 ? "all" : "%d"))
    context.ask(ChangeThreads{threads});
  context.host.mark("settings.threads");
  tooltip_with_key(context, "results do not depend on it", {});
}

void draw_quality(PanelContext& context) {
  constexpr const char* names[] = {"automatic", "draft", "standard", "high"};
  left_label("picture");
  auto index = int(context.state.quality);
  if (ImGui::Combo("##quality", &index, names, 4)) context.state.quality = PictureQuality(index);
  context.host.mark("settings.quality");
  tooltip_with_key(context, "automatic: a draft where a better one would not be fluent", {});
}

/// A slider; true when it was let go, or a number was typed.
bool pull_parameter(const SceneParameter& p, double& value) {
  const std::string id = "##" + p.name;
  const char* format = p.whole() ? "%.0f" : "%.4g";
  if (p.min && p.max) {
    ImGui::SliderScalar(id.c_str(), ImGuiDataType_Double, &value, &*p.min, &*p.max, format,
                        ImGuiSliderFlags_AlwaysClamp);
  } else {
    const float speed = p.whole() ? 0.1f : float(std::max(std::abs(p.value) * 0.01, 1e-3));
    ImGui::DragScalar(id.c_str(), ImGuiDataType_Double, &value, speed, p.min ? &*p.min : nullptr,
                      p.max ? &*p.max : nullptr, format, ImGuiSliderFlags_AlwaysClamp);
  }
  if (p.whole()) value = std::round(value);
  return ImGui::IsItemDeactivatedAfterEdit();
}

/// The numbers that the scene declares. The scene is opened anew once one is let go.
void draw_parameters(PanelContext& context) {
  if (!context.model.parameters || context.model.parameters->empty()) return;
  small_text(context, "scene", palette::accent);
  for (const SceneParameter& p : *context.model.parameters) {
    left_label(label_of(p.name).c_str());
    tooltip_with_key(context, p.doc, {});
    auto& pulled = context.state.pulled_parameters;
    double value = pulled.contains(p.name) ? pulled[p.name] : p.value;
    const bool done = pull_parameter(p, value);
    context.host.mark("parameters." + p.name);
    tooltip_with_key(context, p.doc, {});
    if (ImGui::IsItemActive()) pulled[p.name] = value;
    if (!done) continue;
    pulled.erase(p.name);
    if (value != p.value) context.ask(ChangeParameter{p.name, value});
  }
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
  draw_threads(context);
  draw_quality(context);
  ImGui::PopStyleVar(2);
}

}  // namespace tumble
