#include "viewer/ui/settings_form.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <array>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

void draw_difference(PanelContext& context, const WorldComparison& c) {
  if (!c.fault.empty()) {
    small_text(context, "B has stopped:", palette::red);
    note(c.fault);
  }
  if (!c.first_tick) {
    note("A and B have the same bits so far.");
    return;
  }
  value_row("apart now", quantity_text(c.distance, "m"));
  if (!c.what.empty()) value_row("  most", c.what);
  value_row("at most", quantity_text(c.worst, "m"));
  value_row("differ from tick", fmt::format("{}", *c.first_tick));
  if (!c.first_what.empty()) value_row("  first", c.first_what);
  if (ImGui::Button("Go there")) context.ask(SeekTick{*c.first_tick});
  context.host.mark("compare.go_there");
  tooltip_with_key(context, "the first moment at which they differ", {});
  if (!c.first_body.is_null()) {
    ImGui::SameLine();
    if (ImGui::Button("Look at it")) {
      context.ask(SelectBody{c.first_body});
      context.ask(FocusBody{c.first_body});
    }
    context.host.mark("compare.look");
  }
  const Curve curve{"apart", palette::series[0], c.distances};
  plot(context, "compare.distance", c.times, std::span(&curve, 1), 96, "m");
}

}  // namespace

/// World A is the one that is shown; B is drawn as a ghost beside it.
void draw_compare_panel(PanelContext& context) {
  const WorldComparison* c = context.model.comparison;
  WorldSettings settings = c ? c->settings : context.model.settings;
  if (!c) {
    note("The same world a second time, from this moment on, with other settings: what differs?");
    if (ImGui::Button("Start")) context.ask(Compare{settings});
    context.host.mark("compare.start");
    return;
  }
  draw_difference(context, *c);
  toggle(context, "compare.ghost", "show B", context.state.show_ghost, "as a ghost");
  if (ImGui::Button("End")) context.ask(EndCompare{});
  context.host.mark("compare.end");
  section(context, "Settings of B");
  // B begins anew from what A is now.
  if (draw_settings_form(context, "compare", settings)) context.ask(Compare{settings});
}

}  // namespace tumble
