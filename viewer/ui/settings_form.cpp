#include "viewer/ui/settings_form.hpp"

#include "engine/scene/visitors/known_names.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

class SettingsWidgets : public ParameterWidgets {
 public:
  SettingsWidgets(PanelContext& context, const char* prefix, std::string stepper)
      : ParameterWidgets(context, prefix), stepper_(std::move(stepper)) {}

  template <class T>
  void object(T& value, const Parameter& p) {
    const std::vector<std::string> steppers = known_names("stepper");
    const bool of_stepper = std::ranges::find(steppers, p.name) != steppers.end();
    if (of_stepper && p.name != stepper_) return;
    heading(p);
    T::parameters(*this, value);
  }

 private:
  std::string stepper_;
};

/// A slider; true when it was released, or a number was typed.
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

}  // namespace

/// A label at the left; the next widget fills the rest of the line.
void left_label(const char* text) {
  ImGui::AlignTextToFramePadding();
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  ImGui::TextUnformatted(text);
  ImGui::PopStyleColor();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::SameLine(ImGui::GetStyle().WindowPadding.x + width * 0.56f);
  ImGui::SetNextItemWidth(width * 0.44f);
}

bool draw_threads_slider(PanelContext& context, const char* name, int& threads) {
  const int most = std::max(1, int(std::thread::hardware_concurrency()));
  left_label("threads");
  const bool changed = ImGui::SliderInt(fmt::format("##{}", name).c_str(), &threads, 0, most,
                                        threads == 0 ? "all" : "%d");
  context.host.mark(name);
  tooltip_with_key(context, "results do not depend on it", {});
  return changed;
}

std::optional<ChangeParameter> draw_numbers_form(
    PanelContext& context, const char* prefix,
    const std::function<double(const SceneParameter&)>& value_of) {
  std::optional<ChangeParameter> change;
  for (const SceneParameter& p : *context.model.parameters) {
    left_label(label_of(p.name).c_str());
    tooltip_with_key(context, p.doc, {});
    const std::string name = fmt::format("{}.{}", prefix, p.name);
    auto& pulled = context.state.pulled_parameters;
    const double before = value_of(p);
    double value = pulled.contains(name) ? pulled[name] : before;
    ImGui::PushID(prefix);
    const bool done = pull_parameter(p, value);
    ImGui::PopID();
    context.host.mark(name);
    tooltip_with_key(context, p.doc, {});
    if (ImGui::IsItemActive()) pulled[name] = value;
    if (!done) continue;
    pulled.erase(name);
    if (value != before) change = ChangeParameter{p.name, value};
  }
  return change;
}

bool draw_settings_form(PanelContext& context, const char* prefix, WorldSettings& settings) {
  SettingsWidgets widgets(context, prefix, settings.stepper);
  WorldSettings::parameters(widgets, settings);
  return widgets.changed;
}

}  // namespace tumble
