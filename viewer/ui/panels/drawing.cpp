#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// How an overlay is called on a switch, and the key that flips it.
struct Label {
  std::string_view overlay;
  const char* text;
  std::optional<Action> action;
};
constexpr Label labels[] = {
    {"contacts", "Contacts", Action::overlay_contacts},
    {"normals", "Normals", Action::overlay_normals},
    {"forces", "Contact forces", Action::overlay_forces},
    {"aabbs", "Bounds", Action::overlay_bounds},
    {"joints", "Joints and springs", Action::overlay_joints},
    {"grid", "Broad phase", Action::overlay_grid},
    {"collision_shape", "Collision shapes", Action::overlay_collision_shape},
    {"velocities", "Velocities", std::nullopt},
    {"islands", "Islands and sleep", std::nullopt},
};

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
  }
  ImGui::PopStyleVar();
}

}  // namespace tumble
