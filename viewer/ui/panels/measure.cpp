#include "viewer/ui/curve_plots.hpp"
#include "viewer/ui/fuzzy.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

/// Greatest number of search results shown; typing more letters narrows the search.
constexpr size_t most_found = 8;

void draw_choice(PanelContext& context) {
  std::vector<Quantity> choices = quantities_of(*context.model.frame, context.model.selected);
  if (choices.empty()) note("Select a body to plot what it does.");
  std::ranges::move(quantities_of_sensors(*context.model.frame), std::back_inserter(choices));
  if (choices.empty()) return;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##quantity", "plot ...", ImGuiComboFlags_HeightLarge)) {
    for (const Quantity& q : choices) {
      if (ImGui::Selectable(q.name.c_str())) context.ask(AddCurve{q});
      std::string name = "measure." + q.name;  // one word, for scripts
      std::ranges::replace(name, ' ', '_');
      context.host.mark(name);
    }
    ImGui::EndCombo();
  }
  context.host.mark("measure.choose");
}

/// The names that match a search, best first.
std::vector<std::string> found_names(const std::vector<std::string>& names,
                                     const std::string& search) {
  std::vector<std::pair<int, const std::string*>> scored;
  for (const std::string& name : names)
    if (const auto score = fuzzy_score(search, name)) scored.emplace_back(-*score, &name);
  std::ranges::stable_sort(scored, {}, [](const auto& s) { return s.first; });
  std::vector<std::string> out;
  for (size_t i = 0; i < std::min(scored.size(), most_found); ++i) out.push_back(*scored[i].second);
  return out;
}

/// Search over all quantities that assertions of the scene can use.
void draw_search(PanelContext& context) {
  if (!context.model.quantity_names) return;
  std::string& search = context.state.plot.search;
  ImGui::SetNextItemWidth(-1);
  const bool entered = ImGui::InputTextWithHint("##search", "or by name: a part of it", &search,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  context.host.mark("measure.search");
  if (search.empty()) return;
  PlotChoice& plot = context.state.plot;
  const auto& names = context.model.quantity_names;
  // Scenes can have many thousands of names, so the search is not repeated for every picture.
  if (plot.found_by != search || plot.found_in != names) {
    plot.found = found_names(*names, search);
    plot.found_by = search;
    plot.found_in = names;
  }
  const std::vector<std::string>& found = plot.found;
  if (found.empty()) return note("Nothing in this scene is called that.");
  std::optional<std::string> chosen;
  if (entered) chosen = found.front();
  for (const std::string& name : found) {
    if (ImGui::Selectable(shortened(name, ImGui::GetContentRegionAvail().x).c_str())) chosen = name;
    context.host.mark("measure.found." + name);
  }
  if (!chosen) return;
  context.ask(AddNamedCurve{*chosen});
  search.clear();
}

/// Draws the progress of computing the past of curves that were added late.
void draw_past(PanelContext& context) {
  const auto& share = context.model.past_share;
  if (!share) return;
  const std::string text = fmt::format("computing the past: {:.0f} %", 100 * *share);
  ImGui::ProgressBar(float(*share), ImVec2(ImGui::GetContentRegionAvail().x - 30, 0), text.c_str());
  context.host.mark("measure.past");
  ImGui::SameLine();
  if (icon_button(context, "measure.leave_past", Icon::close, "the curves begin where they do now",
                  {}, 20))
    context.ask(LeavePast{});
}

PlottedCurve curve_of(const Measures::Series& series, size_t index) {
  return {series.quantity.name, series.quantity.unit,
          palette::series[index % palette::series_count], series.at, series.values};
}

/// Counts have no decimals.
std::string value_text(double value, const std::string& unit) {
  const bool whole = unit.empty() && std::abs(value) < 1e6 && value == std::rint(value);
  return whole ? fmt::format("{:.0f}", value) : quantity_text(value, unit);
}

void draw_heading(PanelContext& context, const Measures::Series& series, size_t index) {
  ImGui::PushID(int(index));
  ImGui::AlignTextToFramePadding();
  const float end = ImGui::GetContentRegionMax().x - 26;
  const std::string now =
      series.values.empty() ? "-" : value_text(double(series.values.back()), series.quantity.unit);
  ImGui::PushFont(context.host.fonts().small);
  const float value = ImGui::CalcTextSize(now.c_str()).x + 10;
  const std::string name = shortened(series.quantity.name, end - ImGui::GetCursorPosX() - value);
  ImGui::PopFont();
  small_text(context, name, palette::text);
  ImGui::SameLine();
  small_text(context, now, palette::series[index % palette::series_count]);
  ImGui::SameLine(ImGui::GetContentRegionMax().x - 22);
  if (icon_button(context, fmt::format("measure.{}.close", index), Icon::close, "no longer", {},
                  20))
    context.ask(RemoveCurve{index});
  ImGui::PopID();
}

void draw_form(PanelContext& context) {
  PlotForm& form = context.state.plot.form;
  const auto choice = [&](const char* name, const char* text, PlotForm which, const char* doc) {
    if (word_button(context, name, text, form == which, doc, {})) form = which;
    ImGui::SameLine(0, 2);
  };
  choice("measure.apart", "Apart", PlotForm::apart, "each curve in a frame of its own");
  choice("measure.together", "Together", PlotForm::together,
         "one frame, and an axis for each unit");
  choice("measure.phase", "Phase", PlotForm::phase, "one quantity against another");
  ImGui::NewLine();
}

/// Draws the choice of the curve for an axis of the phase plot.
void draw_axis_choice(PanelContext& context, const char* label, const char* name, size_t& index) {
  const auto& all = context.model.measures->series();
  index = std::min(index, all.size() - 1);
  ImGui::AlignTextToFramePadding();
  small_text(context, label, palette::dim);
  ImGui::SameLine(64);
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo(fmt::format("##{}", name).c_str(), all[index].quantity.name.c_str())) {
    for (size_t i = 0; i < all.size(); ++i) {
      ImGui::PushID(int(i));
      if (ImGui::Selectable(all[i].quantity.name.c_str(), i == index)) index = i;
      context.host.mark(fmt::format("{}.{}", name, i));
      ImGui::PopID();
    }
    ImGui::EndCombo();
  }
  context.host.mark(name);
}

void draw_phase(PanelContext& context, float height) {
  const auto& all = context.model.measures->series();
  const PlotChoice& plot = context.state.plot;
  const size_t x = std::min(plot.across, all.size() - 1), y = std::min(plot.up, all.size() - 1);
  plot_phase(context, "measure.phase_plot", curve_of(all[x], x), curve_of(all[y], y), height);
}

void draw_together(PanelContext& context, float height) {
  const auto& all = context.model.measures->series();
  std::vector<PlottedCurve> curves;
  for (size_t i = 0; i < all.size(); ++i) curves.push_back(curve_of(all[i], i));
  plot_over_time(context, "measure.all", curves, height);
}

}  // namespace

void draw_measure_panel(PanelContext& context) {
  draw_choice(context);
  draw_search(context);
  const auto& all = context.model.measures->series();
  if (all.empty()) return;
  draw_past(context);
  draw_form(context);
  PlotChoice& choice = context.state.plot;
  for (size_t i = 0; i < all.size(); ++i) {
    draw_heading(context, all[i], i);
    if (choice.form != PlotForm::apart) continue;
    const PlottedCurve curve = curve_of(all[i], i);
    plot_over_time(context, fmt::format("measure.{}", i), std::span(&curve, 1), 92);
  }
  if (choice.form == PlotForm::together) draw_together(context, 190);
  if (choice.form == PlotForm::phase) {
    draw_axis_choice(context, "across", "measure.across", choice.across);
    draw_axis_choice(context, "up", "measure.up", choice.up);
    draw_phase(context, 220);
  }
  if (ImGui::Button("Write CSV")) context.ask(WriteMeasures{});
  context.host.mark("measure.csv");
  tooltip_with_key(context, "into the folder of screenshots", {});
  ImGui::SameLine();
  if (ImGui::Button("Write PNG")) context.ask(WritePlot{});
  context.host.mark("measure.png");
  tooltip_with_key(context, "a picture of the plot, into the folder of screenshots", {});
}

/// Draws only the plot, over a whole picture.
void draw_plot_page(PanelContext& context, float width, float height) {
  const auto& all = context.model.measures->series();
  if (all.empty()) return;
  ImGui::SetNextWindowPos(ImVec2(0, 0));
  ImGui::SetNextWindowSize(ImVec2(width, height));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, palette::page);
  ImGui::Begin(
      "##plot page", nullptr,
      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoInputs);
  const auto& m = context.model;
  ImGui::TextUnformatted((m.scene_title.empty() ? m.scene_name : m.scene_title).c_str());
  const PlotChoice& choice = context.state.plot;
  if (choice.form == PlotForm::phase) {
    const size_t x = std::min(choice.across, all.size() - 1),
                 y = std::min(choice.up, all.size() - 1);
    small_text(context, fmt::format("{} over {}", all[y].quantity.name, all[x].quantity.name),
               palette::series[y % palette::series_count]);
  } else {
    for (size_t i = 0; i < all.size(); ++i) {
      small_text(context, all[i].quantity.name, palette::series[i % palette::series_count]);
      ImGui::SameLine(0, 18);
      const float next =
          i + 1 < all.size() ? ImGui::CalcTextSize(all[i + 1].quantity.name.c_str()).x : 0;
      if (ImGui::GetCursorPosX() + next > width - 16) ImGui::NewLine();
    }
    ImGui::NewLine();
  }
  const float rest = ImGui::GetContentRegionAvail().y - 4;
  if (choice.form == PlotForm::phase)
    draw_phase(context, rest);
  else if (choice.form == PlotForm::together || all.size() < 2)
    draw_together(context, rest);
  else
    for (size_t i = 0; i < all.size(); ++i) {
      const PlottedCurve curve = curve_of(all[i], i);
      plot_over_time(context, fmt::format("page.{}", i), std::span(&curve, 1),
                     rest / float(all.size()) - ImGui::GetStyle().ItemSpacing.y);
    }
  ImGui::End();
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(2);
}

}  // namespace tumble
