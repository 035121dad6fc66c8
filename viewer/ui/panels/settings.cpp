#include "engine/scene/visitors/known_names.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

/// "contact_damping_ratio" as people write it.
std::string label_of(std::string_view name) {
  std::string label(name);
  for (char& c : label)
    if (c == '_') c = ' ';
  return label;
}

/// A widget for each declared parameter; `changed` when one of them was edited.
class ParameterWidgets {
 public:
  /// Of the steppers only the one in use shows its settings.
  ParameterWidgets(PanelContext& context, std::string stepper)
      : context_(context), stepper_(std::move(stepper)) {}
  bool changed = false;

  void field(double& value, const Parameter& p) {
    begin(p);
    double v = value;
    const float speed = float(std::max(std::abs(v) * 0.01, 1e-3));
    const std::string format = p.unit.empty() ? "%.4g" : fmt::format("%.4g {}", p.unit);
    if (ImGui::DragScalar(id(p), ImGuiDataType_Double, &v, speed, nullptr, nullptr,
                          format.c_str()) &&
        fits(v, p)) {
      value = v;
      changed = true;
    }
    end(p);
  }
  void field(int& value, const Parameter& p) {
    begin(p);
    int v = value;
    if (ImGui::DragInt(id(p), &v, 0.1f, int(std::max(p.min, -1e6)), int(std::min(p.max, 1e6)))) {
      if (fits(v, p)) {
        value = v;
        changed = true;
      }
    }
    end(p);
  }
  void field(bool& value, const Parameter& p) {
    if (toggle(context_, mark_name(p), label_of(p.name).c_str(), value)) changed = true;
    tooltip_with_key(context_, p.doc, {});
  }
  void field(Vec3& value, const Parameter& p) {
    begin(p);
    float v[3] = {float(value.x()), float(value.y()), float(value.z())};
    if (ImGui::DragFloat3(id(p), v, 0.02f, 0, 0, "%.2f")) {
      const Vec3 wanted(v[0], v[1], v[2]);
      if (wanted.allFinite()) {
        // An axis that was not touched keeps all its digits.
        for (int i = 0; i < 3; ++i)
          if (double(v[i]) != double(float(value[i]))) value[i] = double(v[i]);
        changed = true;
      }
    }
    end(p);
  }
  void field(TickRate& value, const Parameter& p) {
    begin(p);
    auto hz = int(std::lround(double(value.num) / double(value.den)));
    if (ImGui::DragInt(id(p), &hz, 1, int(p.min), 2000, "%d Hz") && fits(hz, p)) {
      value = {hz, 1};
      changed = true;
    }
    end(p);
  }
  void field(std::string& value, const Parameter& p) {
    const std::vector<std::string> names = known_names(p.name);
    if (names.empty()) {
      value_row(label_of(p.name), value);
      return;
    }
    begin(p);
    if (ImGui::BeginCombo(id(p), value.c_str())) {
      for (const std::string& name : names) {
        const bool chosen = ImGui::Selectable(name.c_str(), name == value);
        context_.host.mark(fmt::format("{}.{}", mark_name(p), name));
        if (!chosen || name == value) continue;
        value = name;
        changed = true;
      }
      ImGui::EndCombo();
    }
    end(p);
  }
  template <class T>
  void object(T& value, const Parameter& p) {
    const std::vector<std::string> steppers = known_names("stepper");
    const bool of_stepper = std::find(steppers.begin(), steppers.end(), p.name) != steppers.end();
    if (of_stepper && p.name != stepper_) return;
    ImGui::Dummy(ImVec2(0, 2));
    small_text(context_, label_of(p.name), palette::accent);
    T::parameters(*this, value);
  }

 private:
  static bool fits(double v, const Parameter& p) {
    return std::isfinite(v) && v <= p.max && (p.exclusive_min ? v > p.min : v >= p.min);
  }
  std::string mark_name(const Parameter& p) const { return fmt::format("settings.{}", p.name); }
  const char* id(const Parameter& p) {
    id_ = fmt::format("##{}", p.name);
    return id_.c_str();
  }
  void begin(const Parameter& p) {
    const std::string label = label_of(p.name);
    const float width = ImGui::GetContentRegionAvail().x, wide = 0.56f;
    const float x = ImGui::GetCursorPosX();
    ImGui::AlignTextToFramePadding();
    ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::PushClipRect(at, {at.x + width * wide - 4, at.y + 30}, true);
    ImGui::TextUnformatted(label.c_str());
    ImGui::PopClipRect();
    ImGui::PopStyleColor();
    tooltip_with_key(context_, p.doc, {});
    const bool three = p.name == "gravity";
    if (!three) ImGui::SameLine(x + width * wide);
    ImGui::SetNextItemWidth(three ? width : width * (1 - wide));
  }
  void end(const Parameter& p) {
    context_.host.mark(mark_name(p));
    tooltip_with_key(context_, p.doc, {});
  }

  PanelContext& context_;
  std::string stepper_;
  std::string id_;
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
  ParameterWidgets widgets(context, settings.stepper);
  WorldSettings::parameters(widgets, settings);
  if (widgets.changed) context.ask(ChangeSettings{settings});

  ImGui::Dummy(ImVec2(0, 2));
  small_text(context, "machine", palette::accent);
  draw_threads(context);
  draw_quality(context);
  ImGui::PopStyleVar(2);
}

}  // namespace tumble
