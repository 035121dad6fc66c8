#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

void draw_choice(PanelContext& context) {
  std::vector<Quantity> choices = quantities_of(*context.model.frame, context.model.selected);
  if (choices.empty()) note("Select a body to plot what it does.");
  std::ranges::move(quantities_of_sensors(*context.model.frame), std::back_inserter(choices));
  if (choices.empty()) return;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##quantity", "plot ...", ImGuiComboFlags_HeightLarge)) {
    for (const Quantity& q : choices) {
      if (ImGui::Selectable(q.name.c_str())) context.ask(AddCurve{q});
      std::string name = "measure." + q.name;  // in one word, for scripts
      std::ranges::replace(name, ' ', '_');
      context.host.mark(name);
    }
    ImGui::EndCombo();
  }
  context.host.mark("measure.choose");
}

void draw_series(PanelContext& context, const Measures::Series& series, size_t index) {
  ImGui::PushID(int(index));
  ImGui::AlignTextToFramePadding();
  small_text(context, series.quantity.name, palette::text);
  const std::string now = series.values.empty()
                              ? "-"
                              : quantity_text(double(series.values.back()), series.quantity.unit);
  ImGui::SameLine();
  small_text(context, now, palette::series[index % palette::series_count]);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - 22);
  const std::string name = fmt::format("measure.{}.close", index);
  if (icon_button(context, name, Icon::close, "no longer", {}, 20)) context.ask(RemoveCurve{index});
  const Curve curve{series.quantity.name, palette::series[index % palette::series_count],
                    series.values};
  plot(context, fmt::format("measure.{}", index), series.at, std::span(&curve, 1), 84,
       series.quantity.unit);
  ImGui::PopID();
}

}  // namespace

void draw_measure_panel(PanelContext& context) {
  draw_choice(context);
  const auto& all = context.model.measures->series();
  for (size_t i = 0; i < all.size(); ++i) draw_series(context, all[i], i);
  if (all.empty()) return;
  if (ImGui::Button("Write CSV")) context.ask(WriteMeasures{});
  context.host.mark("measure.csv");
  tooltip_with_key(context, "into the folder of screenshots", {});
}

}  // namespace tumble
