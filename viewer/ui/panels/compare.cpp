#include "engine/dynamics/simd/simd_target.hpp"
#include "viewer/ui/curve_plots.hpp"
#include "viewer/ui/difference_text.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/settings_form.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// Distance for display; infinite if only one of the worlds has the body.
std::string apart_text(double distance) {
  return std::isfinite(distance) ? quantity_text(distance, "m") : std::string("in one world only");
}

/// Draws the differences in settings, one line each: A's value, then B's.
void draw_choices(PanelContext& context, const WorldComparison& c) {
  if (c.differences.empty()) return note("Nothing is chosen otherwise for B yet: see below.");
  small_text(context, "A and B differ in", palette::accent);
  for (const WorldDifference& d : c.differences) {
    note(difference_text(d));
    context.host.mark("compare.differs." + d.path);
  }
  if (c.from_start) note("With other numbers B is another scene: both begin at its start.");
  if (c.behind > 0) note(fmt::format("B is on its way to this moment: {:.2f} s to go.", c.behind));
  if (c.alone) note("B is not made of the same bodies: what is done to A is not done to it.");
}

void draw_difference(PanelContext& context, const WorldComparison& c) {
  if (!c.fault.empty()) {
    small_text(context, "B has stopped:", palette::red);
    note(c.fault);
  }
  if (c.opening) note("B is being made ...");
  if (c.times.empty()) return;
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
  if (c.first_contact) {
    note(fmt::format("first contact that differs, at tick {}: {}", c.first_contact->tick,
                     c.first_contact->what));
    if (!c.first_contact->a.is_null() && !c.first_contact->b.is_null()) {
      if (ImGui::Button("Look into the contact")) {
        context.ask(SeekTick{c.first_contact->tick});
        context.ask(SelectContact{
            ContactPick{c.first_contact->a, c.first_contact->b, c.first_contact->x_world}});
      }
      context.host.mark("compare.contact");
      tooltip_with_key(context, "goes to that moment, and shows what the contact claims", {});
    }
  }
  const PlottedCurve curve{"apart", "m", palette::series[0], c.times, c.distances};
  plot_over_time(context, "compare.distance", std::span(&curve, 1), 110);
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

/// Draws the choice of B's instruction set and number of threads; true if one was changed.
bool draw_machine(PanelContext& context, WorldChoice& choice) {
  bool changed = draw_threads_slider(context, "compare.threads", choice.threads);
  static const std::vector<std::string> targets = simd_targets();
  left_label("SIMD");
  if (ImGui::BeginCombo("##simd", choice.simd.empty() ? "the best" : choice.simd.c_str())) {
    const auto offer = [&](const std::string& name, const char* text) {
      if (ImGui::Selectable(text, choice.simd == name)) {
        changed = changed || choice.simd != name;
        choice.simd = name;
      }
      context.host.mark("compare.simd." + (name.empty() ? std::string("best") : name));
    };
    offer({}, "the best");
    for (const std::string& name : targets) offer(name, name.c_str());
    ImGui::EndCombo();
  }
  context.host.mark("compare.simd");
  tooltip_with_key(context, "instructions that B is computed by; results do not depend on it", {});
  return changed;
}

/// True when another number was chosen for B.
bool draw_numbers(PanelContext& context, WorldChoice& choice) {
  if (!context.model.parameters || context.model.parameters->empty()) return false;
  section(context, "Numbers of B");
  const auto of_b = [&](const SceneParameter& p) {
    const auto found =
        std::ranges::find(choice.numbers, p.name, &std::pair<std::string, double>::first);
    return found == choice.numbers.end() ? p.value : found->second;
  };
  const auto change = draw_numbers_form(context, "compare.parameters", of_b);
  if (!change) return false;
  for (auto& [name, value] : choice.numbers)
    if (name == change->name) value = change->value;
  return true;
}

WorldChoice choice_of_a(const UiModel& model) {
  WorldChoice choice;
  choice.settings = model.settings;
  choice.threads = model.threads;
  if (model.parameters)
    for (const SceneParameter& p : *model.parameters) choice.numbers.emplace_back(p.name, p.value);
  return choice;
}

}  // namespace

/// Draws the panel. World A is the one shown; B is drawn transparently in its picture, or beside
/// it.
void draw_compare_panel(PanelContext& context) {
  const WorldComparison* c = context.model.comparison;
  if (!c) {
    note(
        "The same world a second time, from this moment on, with other settings, numbers or ways "
        "to compute it: what differs?");
    if (ImGui::Button("Start")) context.ask(Compare{choice_of_a(context.model)});
    context.host.mark("compare.start");
    return;
  }
  WorldChoice choice = c->choice;
  draw_choices(context, *c);
  draw_difference(context, *c);
  draw_view_choice(context);
  if (ImGui::Button("End")) context.ask(EndCompare{});
  context.host.mark("compare.end");
  bool changed = draw_numbers(context, choice);
  section(context, "How B is computed");
  changed = draw_machine(context, choice) || changed;
  section(context, "Settings of B");
  changed = draw_settings_form(context, "compare", choice.settings) || changed;
  // B is restarted: as a copy of A's present state, or together with A from the start.
  if (changed) context.ask(Compare{std::move(choice)});
}

}  // namespace tumble
