#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <numbers>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

void draw_ruler_mode(PanelContext& context) {
  UiState& state = context.state;
  const auto choice = [&](const char* name, const char* text, bool angle, const char* doc) {
    const bool on = state.ruling && state.ruling_angle == angle;
    if (word_button(context, name, text, on, doc, {})) {
      state.ruling = !on;
      state.ruling_angle = angle;
    }
  };
  choice("ruler.distance", "Distance", false, "between two points on surfaces");
  ImGui::SameLine(0, 2);
  choice("ruler.angle", "Angle", true, "at a corner, between two arms");
  if (!state.ruling) return note("Choose what to measure.");
  const size_t picked = context.model.ruler->picked;
  const char* const next[] = {state.ruling_angle ? "Click on a surface: the end of one arm."
                                                 : "Click on a surface: from here",
                              state.ruling_angle ? "Now the corner." : "... to there.",
                              "Now the end of the other arm."};
  note(next[std::min<size_t>(picked, 2)]);
}

void draw_reading(PanelContext& context, const RulerReading& r, size_t index) {
  ImGui::PushID(int(index));
  ImGui::Separator();
  ImGui::AlignTextToFramePadding();
  const float end = ImGui::GetContentRegionMax().x;
  small_text(context, shortened(r.quantity.name, end - 32), palette::text);
  ImGui::SameLine(end - 22);
  if (icon_button(context, fmt::format("ruler.{}.close", index), Icon::close, "no longer", {}, 20))
    context.ask(RemoveReading{index});
  if (!r.there) {
    note("Not all of its bodies are there at this moment.");
  } else if (r.angle) {
    value_row("angle",
              fmt::format("{:.2f}°  =  {:.4f} rad", r.value * 180 / std::numbers::pi, r.value));
  } else {
    value_row("distance", quantity_text(r.value, "m"));
    value_row("x, y, z",
              fmt::format("{:.3f}, {:.3f}, {:.3f} m", r.apart.x(), r.apart.y(), r.apart.z()));
  }
  if (ImGui::Button("Plot")) {
    context.ask(AddCurve{r.quantity});
    context.state.shows(PanelId::measure) = true;
  }
  context.host.mark(fmt::format("ruler.{}.plot", index));
  tooltip_with_key(context, "as a curve over time", shortcut_of(Action::toggle_measure));
  ImGui::PopID();
}

}  // namespace

void draw_ruler_panel(PanelContext& context) {
  draw_ruler_mode(context);
  const auto& all = context.model.ruler->readings;
  for (size_t i = 0; i < all.size(); ++i) draw_reading(context, all[i], i);
}

}  // namespace tumble
