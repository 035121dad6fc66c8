#include "engine/scene/visitors/known_names.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <algorithm>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <imgui.h>

namespace tumble {
namespace {

/// Of the steppers only the one in use shows its settings.
class SettingsWidgets : public ParameterWidgets {
 public:
  SettingsWidgets(PanelContext& context, std::string stepper)
      : ParameterWidgets(context, "settings"), stepper_(std::move(stepper)) {}

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

}  // namespace

void draw_settings_panel(PanelContext& context) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 4));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(8, 3));
  WorldSettings settings = context.model.settings;
  SettingsWidgets widgets(context, settings.stepper);
  WorldSettings::parameters(widgets, settings);
  if (widgets.changed) context.ask(ChangeSettings{settings});

  ImGui::Dummy(ImVec2(0, 2));
  small_text(context, "machine", palette::accent);
  draw_threads(context);
  draw_quality(context);
  ImGui::PopStyleVar(2);
}

}  // namespace tumble
