#include "viewer/interact/picking.hpp"
#include "viewer/ui/body_form.hpp"
#include "viewer/ui/joint_form.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/settings_form.hpp"
#include "viewer/ui/style.hpp"

#include <string>

#include <fmt/format.h>
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

/// A pinned value that is not there now: of what is deleted or not yet made in this run, or one
/// that its owner has no more.
void draw_missing(PanelContext& context, const Pin& pin, const std::string& mark) {
  small_text(context, label_of_pin(pin) + " is not there", palette::faint);
  ImGui::SameLine();
  if (icon_button(context, mark + ".off", Icon::close, "take it off", {}, 16))
    context.state.pins.flip(pin);
}

/// Draws the values that were pinned in the inspector.
void draw_pins(PanelContext& context) {
  const std::vector<Pin> pins = context.state.pins.all;  // one of them may be taken off here
  if (pins.empty()) return;
  small_text(context, "pinned", palette::accent);
  for (const Pin& pin : pins) {
    const std::string owner = pin.joint.empty() ? pin.body : pin.joint;
    const std::string mark = "pinned." + owner;
    ImGui::PushID(fmt::format("{} {}", owner, pin.value).c_str());
    const auto body = context.model.pinned.find(pin.body);
    const auto slot = body == context.model.pinned.end()
                          ? std::nullopt
                          : find_slot(*context.model.frame, body->second.id);
    const SelectedJoint* joint = nullptr;
    if (slot && body->second.joints)
      for (const SelectedJoint& one : *body->second.joints)
        if (one.def.name == pin.joint && !pin.joint.empty()) joint = &one;
    const auto draw = [&] {
      if (!slot) return false;
      const bool asked = pin.joint.empty() ? !body->second.def : !body->second.joints;
      if (asked) return true;  // it is known soon
      if (!pin.joint.empty()) return joint && draw_pinned_joint_value(context, pin, mark, *joint);
      return draw_pinned_body_value(context, pin, mark, context.model.frame->body(*slot),
                                    *body->second.def);
    };
    if (!draw()) draw_missing(context, pin, mark);
    ImGui::PopID();
  }
  ImGui::Dummy(ImVec2(0, 2));
}

}  // namespace

void draw_settings_panel(PanelContext& context) {
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 4));
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(8, 3));
  draw_parameters(context);
  draw_pins(context);
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
