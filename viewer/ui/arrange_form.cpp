#include "viewer/ui/arrange_form.hpp"

#include "engine/math/rotation.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"

#include <array>
#include <numbers>

#include <imgui.h>

namespace tumble {
namespace {

struct KindButton {
  HandleKind kind;
  Action action;
  const char* name;
  const char* doc;
};
constexpr std::array kinds = {
    KindButton{HandleKind::move, Action::handles_move, "move",
               "arrows and squares that move the selected bodies; dragged itself, a body stands on "
               "what is under the pointer"},
    KindButton{HandleKind::turn, Action::handles_turn, "turn", "rings that turn them"},
    KindButton{HandleKind::scale, Action::handles_scale, "scale",
               "handles that make them larger or smaller, or longer along one axis"},
};

void draw_kinds(PanelContext& context) {
  const float gap = ImGui::GetStyle().ItemSpacing.x;
  const float width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
  for (const KindButton& button : kinds) {
    if (&button != &kinds.front()) ImGui::SameLine();
    const bool lit = context.state.handles.kind == button.kind;
    ImGui::PushStyleColor(ImGuiCol_Button, ImGui::ColorConvertU32ToFloat4(lit ? palette::accent_soft
                                                                              : palette::raised));
    if (ImGui::Button(button.name, ImVec2(width, 0))) context.ask(button.action);
    ImGui::PopStyleColor();
    context.host.mark(std::string("arrange.") + button.name);
    tooltip_with_key(context, button.doc, shortcut_of(button.action));
  }
}

void draw_steps(PanelContext& context, ParameterWidgets& widgets) {
  HandleSettings& handles = context.state.handles;
  widgets.field(handles.own_axes,
                {.name = "own_axes", .doc = "handles along the body's axes, not the world's"});
  widgets.field(handles.snap,
                {.name = "snap", .doc = "in steps; Ctrl while dragging: the opposite"});
  switch (handles.kind) {
    case HandleKind::move:
      return widgets.field(handles.step, {.name = "step",
                                          .unit = "m",
                                          .min = 0,
                                          .max = 1000,
                                          .exclusive_min = true,
                                          .doc = "of moves that snap"});
    case HandleKind::turn:
      return widgets.field(handles.step_deg, {.name = "step_deg",
                                              .unit = "deg",
                                              .min = 0,
                                              .max = 180,
                                              .exclusive_min = true,
                                              .doc = "of turns that snap"});
    default:
      return widgets.field(handles.step_scale, {.name = "step_scale",
                                                .min = 0,
                                                .max = 10,
                                                .exclusive_min = true,
                                                .doc = "of sizes that snap, of the size before"});
  }
}

/// The displacement given by the typed numbers, in the frame of the handles.
Displacement typed_way(const HandleSettings& handles, const TypedDisplacement& typed) {
  Displacement way;
  if (handles.kind == HandleKind::move) way.shift = typed.shift;
  if (handles.kind == HandleKind::turn)
    way.turn = euler_xyz(Vec3(typed.turn_deg * std::numbers::pi / 180));
  if (handles.kind == HandleKind::scale) way.scale = typed.scale;
  return way;
}

void draw_typed(PanelContext& context, ParameterWidgets& widgets) {
  TypedDisplacement& typed = context.state.typed;
  switch (context.state.handles.kind) {
    case HandleKind::move:
      widgets.field(
          typed.shift,
          {.name = "by", .unit = "m", .min = -1e6, .max = 1e6, .doc = "along the handles"});
      break;
    case HandleKind::turn:
      widgets.field(typed.turn_deg, {.name = "about_xyz",
                                     .unit = "deg",
                                     .min = -360,
                                     .max = 360,
                                     .doc = "about the axes of the handles"});
      break;
    default:
      widgets.field(typed.scale, {.name = "times",
                                  .min = 0.001,
                                  .max = 1000,
                                  .doc = "as large as now, in every direction"});
  }
  if (ImGui::Button("Apply", ImVec2(ImGui::GetContentRegionAvail().x, 0)))
    context.ask(DisplaceSelected{typed_way(context.state.handles, typed)});
  context.host.mark("arrange.apply");
  tooltip_with_key(context, "what a drag of the handles would do, with these numbers", {});
}

}  // namespace

void draw_arrange_form(PanelContext& context) {
  section(context, "Arrange");
  draw_kinds(context);
  if (context.state.handles.kind == HandleKind::none) return;
  ParameterWidgets widgets(context, "arrange");
  draw_steps(context, widgets);
  draw_typed(context, widgets);
}

}  // namespace tumble
