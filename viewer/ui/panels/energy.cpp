#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// A name beside a dash of its curve's colour, and a value.
void legend_cell(PanelContext& context, const Curve& curve, double value) {
  ImGui::TableNextColumn();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float middle = at.y + 0.5f * ImGui::GetTextLineHeight() + 1;
  ImGui::GetWindowDrawList()->AddRectFilled({at.x, middle - 1.5f}, {at.x + 10, middle + 1.5f},
                                            curve.colour, 1);
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 16);
  small_text(context, curve.label, palette::dim);
  ImGui::SameLine(0, 6);
  small_text(context, quantity_text(value, "J"), palette::text);
}

void plot_with_legend(PanelContext& context, std::string_view name, std::span<const double> times,
                      std::span<const Curve> curves, std::span<const double> values, float height) {
  plot(context, name, times, curves, height, "J");
  ImGui::Dummy(ImVec2(0, 1));
  ImGui::PushID(name.data());
  if (ImGui::BeginTable("##legend", 2, ImGuiTableFlags_SizingStretchSame)) {
    for (size_t i = 0; i < curves.size(); ++i) legend_cell(context, curves[i], values[i]);
    ImGui::EndTable();
  }
  ImGui::PopID();
}

void draw_energies(PanelContext& context, std::span<const History::Sample> samples,
                   std::span<const double> times) {
  const Energies& now = context.model.frame->stats.energies;
  struct Part {
    std::string_view label;
    uint32_t colour;
    double Energies::*value;
  };
  const Part parts[] = {{"kinetic", palette::blue, &Energies::kinetic},
                        {"gravity", palette::green, &Energies::gravity},
                        {"springs", palette::violet, &Energies::springs},
                        {"fields", palette::yellow, &Energies::fields}};
  std::vector<Curve> curves;
  std::vector<double> values;
  for (const Part& part : parts) {
    if (part.value == &Energies::fields && now.fields == 0) continue;
    Curve& curve = curves.emplace_back(Curve{part.label, part.colour, {}});
    for (const History::Sample& s : samples) curve.values.push_back(float(s.energies.*part.value));
    values.push_back(now.*part.value);
  }
  Curve& total = curves.emplace_back(Curve{"total", palette::accent, {}});
  for (const History::Sample& s : samples) total.values.push_back(float(s.energies.total()));
  values.push_back(now.total());
  plot_with_legend(context, "energy.plot", times, curves, values, 124);
}

/// Draws the energy added or removed by each cause since the left end of the plot; causes that did
/// nothing are left out.
void draw_ledger(PanelContext& context, std::span<const History::Sample> samples,
                 std::span<const double> times) {
  const Ledger* ledger = context.model.frame->ledger.get();
  if (!ledger || samples.empty()) return;
  section(context, "Ledger");
  std::array<std::vector<float>, ledger_lines + 1> lines;
  std::array<float, ledger_lines + 1> most{};
  for (size_t i = 0; i < lines.size(); ++i)
    for (const History::Sample& s : samples) {
      lines[i].push_back(s.ledger[i] - samples.front().ledger[i]);
      most[i] = std::max(most[i], std::fabs(lines[i].back()));
    }
  const float greatest = *std::max_element(most.begin(), most.end());
  std::vector<Curve> curves;
  std::vector<double> values;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (!(most[i] > 1e-9f * greatest)) continue;  // zero up to rounding
    values.push_back(double(lines[i].back()));
    if (i < ledger_lines)
      curves.push_back({ledger_line_name(LedgerLine(i)),
                        palette::series[i % size_t(palette::series_count)], std::move(lines[i])});
    else
      curves.push_back({"forces", palette::dim, std::move(lines[i])});
  }
  plot_with_legend(context, "energy.ledger", times, curves, values, 92);
  value_row("integrator / throughput", fmt::format("{:.1e}", ledger->drift()));
}

}  // namespace

void draw_energy_panel(PanelContext& context) {
  const auto& samples = context.model.history->samples();
  std::vector<double> times;
  for (const History::Sample& s : samples) times.push_back(s.time);
  draw_energies(context, samples, times);
  draw_ledger(context, samples, times);
}

}  // namespace tumble
