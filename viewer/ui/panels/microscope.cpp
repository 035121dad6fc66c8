#include "viewer/render/ink.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

void draw_algorithms(PanelContext& context) {
  MicroscopeChoice& choice = context.state.microscope;
  const std::string& now = context.model.microscope_algorithm;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  if (ImGui::BeginCombo("##algorithm", words_of(now).c_str())) {
    for (const MicroscopeEntry& entry : all_microscopes()) {
      const std::string name(entry.name);
      if (ImGui::Selectable(words_of(name).c_str(), name == now)) choice = {name, std::nullopt};
      context.host.mark("microscope." + name);
      tooltip_with_key(context, entry.doc, {});
    }
    ImGui::EndCombo();
  }
  context.host.mark("microscope.algorithm");
}

void draw_steps(PanelContext& context, int count) {
  int step = context.model.microscope_step + 1;
  const auto button = [&](const char* name, Icon icon, const char* tip, Action action) {
    if (icon_button(context, name, icon, tip, shortcut_of(action), 26)) context.ask(action);
    ImGui::SameLine(0, 4);
  };
  button("microscope.first", Icon::restart, "first step", Action::microscope_first);
  button("microscope.previous", Icon::step_back, "previous step", Action::microscope_previous);
  button("microscope.next", Icon::step_forward, "next step", Action::microscope_next);
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x);
  const std::string text = fmt::format("%d of {}", count);
  if (ImGui::SliderInt("##step", &step, 1, count, text.c_str(), ImGuiSliderFlags_AlwaysClamp))
    context.state.microscope.step = step - 1;
  context.host.mark("microscope.step");
}

void draw_diagram(const Diagram& d) {
  if (d.empty()) return;
  const float width = ImGui::GetContentRegionAvail().x, tall = width / float(d.aspect);
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImDrawList& out = *ImGui::GetWindowDrawList();
  const auto at = [&](const Vec2& p) {
    return ImVec2(corner.x + float(p.x()) * tall, corner.y + (1 - float(p.y())) * tall);
  };
  for (const Diagram::Box& b : d.boxes) {
    const ImVec2 low = at(b.min), high = at(b.max);
    out.AddRectFilled({low.x, high.y}, {high.x, low.y}, ink_on_plate(b.ink, b.opacity), 3);
  }
  for (const Diagram::Line& l : d.lines) {
    const ImVec2 a = at(l.a), b = at(l.b);
    out.AddLine(a, b, ink_on_plate(l.ink), l.width);
    const float dx = b.x - a.x, dy = b.y - a.y, n = std::sqrt(dx * dx + dy * dy);
    if (!l.arrow || !(n > 0)) continue;
    const float ux = dx / n * 4, uy = dy / n * 4;
    out.AddTriangleFilled({b.x + ux, b.y + uy}, {b.x - ux - uy, b.y - uy + ux},
                          {b.x - ux + uy, b.y - uy - ux}, ink_on_plate(l.ink));
  }
  for (const Diagram::Point& p : d.points)
    out.AddCircleFilled(at(p.x), 0.5f * p.size, ink_on_plate(p.ink));
  for (const Diagram::Label& l : d.labels) {
    const ImVec2 size = ImGui::CalcTextSize(l.text.c_str()), p = at(l.x);
    out.AddText({p.x - float(l.anchor.x()) * size.x, p.y - (1 - float(l.anchor.y())) * size.y},
                l.ink == Ink::plain ? palette::text : ink_on_plate(l.ink), l.text.c_str());
  }
  ImGui::Dummy(ImVec2(width, tall));
}

}  // namespace

void draw_microscope_panel(PanelContext& context) {
  const UiModel& model = context.model;
  if (model.microscope_algorithm.empty()) {
    note(
        fmt::format("Nothing is under the microscope. Select a body and press {}: it is looked at "
                    "together with its nearest neighbour. Fluids need no selection.",
                    shortcut_of(Action::toggle_microscope)));
    return;
  }
  draw_algorithms(context);
  if (!model.microscope) {
    if (!model.microscope_refusal.empty())
      note(model.microscope_refusal);
    else if (model.microscope_waits)
      note(fmt::format("This algorithm is watched in a world that stands still: press {}.",
                       shortcut_of(Action::toggle_pause)));
    else
      note("Looking ...");
    return;
  }
  const auto& steps = model.microscope->steps;
  const size_t index = size_t(std::clamp(model.microscope_step, 0, int(steps.size()) - 1));
  const MicroscopeStep& step = steps[index];
  draw_steps(context, int(steps.size()));
  section(context, step.title.c_str());
  wrapped(step.caption, palette::text);
  ImGui::Dummy(ImVec2(0, 3));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  for (const MicroscopeStep::Number& n : step.numbers) value_row(n.label, n.value);
  ImGui::PopStyleVar();
  if (!step.diagram.empty()) section(context, step.diagram.title.c_str());
  draw_diagram(step.diagram);
}

}  // namespace tumble
