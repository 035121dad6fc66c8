#include "viewer/ui/settings_form.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// What only one of the two worlds has is nowhere in the other.
std::string apart_text(double distance) {
  return std::isfinite(distance) ? quantity_text(distance, "m") : std::string("in one world only");
}

void draw_difference(PanelContext& context, const WorldComparison& c) {
  if (!c.fault.empty()) {
    small_text(context, "B has stopped:", palette::red);
    note(c.fault);
  }
  if (!c.first_tick) {
    note("A and B have the same bits so far.");
    return;
  }
  value_row("apart now", apart_text(c.distance));
  if (!c.what.empty()) value_row("  most", c.what);
  value_row("at most", apart_text(c.worst));
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

void draw_view_choice(PanelContext& context) {
  struct Way {
    ComparedAs as;
    const char *name, *text, *doc;
  };
  constexpr Way ways[] = {
      {ComparedAs::ghost, "compare.ghost", "ghost", "B seen through, in the picture of A"},
      {ComparedAs::beside, "compare.beside", "side by side", "a picture of B beside that of A"},
      {ComparedAs::hidden, "compare.hidden", "A alone", "B goes on, and is not drawn"}};
  ComparedAs& as = context.state.compared_as;
  for (const Way& way : ways) {
    if (way.as != ComparedAs::ghost) ImGui::SameLine(0, 4);
    if (word_button(context, way.name, way.text, as == way.as, way.doc,
                    shortcut_of(Action::next_comparison_view)))
      as = way.as;
  }
}

}  // namespace

/// World A is the one that is shown; B is drawn as a ghost in its picture, or beside it.
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
  draw_view_choice(context);
  if (ImGui::Button("End")) context.ask(EndCompare{});
  context.host.mark("compare.end");
  section(context, "Settings of B");
  // B begins anew from what A is now.
  if (draw_settings_form(context, "compare", settings)) context.ask(Compare{settings});
}

}  // namespace tumble
