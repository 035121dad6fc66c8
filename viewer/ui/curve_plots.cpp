#include "viewer/ui/curve_plots.hpp"

#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// A vertical axis between two round values, with grid lines.
struct Axis {
  double low = 0, high = 1, step = 1;
  uint32_t colour = 0;
  std::string_view unit;

  double share(double v) const { return (v - low) / (high - low); }
};

Axis axis_over(std::span<const PlottedCurve> curves, double lines) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const PlottedCurve& curve : curves)
    for (const float v : curve.values)
      if (std::isfinite(v)) {
        low = std::min(low, double(v));
        high = std::max(high, double(v));
      }
  if (!(low <= high)) low = 0, high = 1;
  // A constant curve is centred in a range wider than rounding errors.
  const double least = std::max(1e-6 * std::max(std::abs(low), std::abs(high)), 1e-12);
  if (high - low < least) {
    const bool zero = low == 0 && high == 0;  // e.g. what has not begun to move
    low -= zero ? 1 : 0.5 * std::max(std::abs(low), 1e-9);
    high += zero ? 1 : 0.5 * std::max(std::abs(high), 1e-9);
  }
  Axis axis;
  axis.step = round_step(high - low, lines);
  axis.low = axis.step * std::floor(low / axis.step + 1e-9);
  axis.high = axis.step * std::ceil(high / axis.step - 1e-9);
  axis.colour = curves.size() == 1 ? curves[0].colour : palette::faint;
  axis.unit = curves[0].unit;
  return axis;
}

/// Makes one axis per unit; of_curve gets the index of each curve's axis.
std::vector<Axis> axes_of(std::span<const PlottedCurve> curves, double lines,
                          std::vector<size_t>& of_curve) {
  std::vector<std::string_view> units;
  for (const PlottedCurve& curve : curves) {
    const auto known = std::ranges::find(units, curve.unit);
    of_curve.push_back(size_t(known - units.begin()));
    if (known == units.end()) units.push_back(curve.unit);
  }
  std::vector<Axis> axes;
  for (size_t k = 0; k < units.size(); ++k) {
    std::vector<PlottedCurve> same;
    for (size_t i = 0; i < curves.size(); ++i)
      if (of_curve[i] == k) same.push_back(curves[i]);
    axes.push_back(axis_over(same, lines));
  }
  return axes;
}

/// Outer frame of a plot, and the part of it for the curves.
struct PlotFrame {
  ImVec2 at, end;
  float x0 = 0, x1 = 1, y0 = 0, y1 = 1;  ///< y0 is the lower edge

  float x(double share) const { return x0 + float(share) * (x1 - x0); }
  float y(double share) const { return y0 + float(share) * (y1 - y0); }
};

PlotFrame begin_plot(PanelContext& context, std::string_view name, float height) {
  PlotFrame f;
  f.at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::InvisibleButton(std::string(name).c_str(), ImVec2(width, height));
  context.host.mark(name);
  f.end = ImVec2(f.at.x + width, f.at.y + height);
  ImGui::GetWindowDrawList()->AddRectFilled(f.at, f.end, palette::well, 5);
  const float line = context.host.fonts().small->FontSize;
  f.x0 = f.at.x + 6;
  f.y0 = f.end.y - line - 4;
  f.y1 = f.at.y + 0.5f * line + 2;
  return f;
}

/// Draws the value axes at the right, one column each, and shrinks the part for the curves
/// accordingly.
void draw_value_axes(PanelContext& context, std::span<const Axis> axes, PlotFrame& f) {
  ImGui::PushFont(context.host.fonts().small);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float line = ImGui::GetTextLineHeight();
  float right = f.end.x - 6;
  for (const Axis& axis : axes) {
    float width = axes.size() == 1 ? 52 : 30;
    const auto lines = int(std::lround((axis.high - axis.low) / axis.step));
    for (int k = 0; k <= lines; ++k) {
      const std::string text = round_text(axis.low + k * axis.step, axis.unit);
      width = std::max(width, ImGui::CalcTextSize(text.c_str()).x);
    }
    // Without room for more axes, values can still be read with the pointer.
    if (right - width - 12 < f.at.x + 0.4f * (f.end.x - f.at.x)) break;
    for (int k = 0; k <= lines; ++k) {
      const double v = axis.low + k * axis.step;
      const std::string text = round_text(v, axis.unit);
      const float y = f.y(axis.share(v));
      list.AddText({right - ImGui::CalcTextSize(text.c_str()).x, y - 0.5f * line}, axis.colour,
                   text.c_str());
    }
    right -= width + 10;
  }
  f.x1 = right - 2;
  if (axes.size() == 1) {
    const Axis& axis = axes[0];
    const auto lines = int(std::lround((axis.high - axis.low) / axis.step));
    for (int k = 0; k <= lines; ++k) {
      const double v = axis.low + k * axis.step;
      const float y = f.y(axis.share(v));
      const bool zero = std::abs(v) < 1e-9 * axis.step;
      list.AddLine({f.x0, y}, {f.x1, y}, palette::faded(palette::text, zero ? 0.22f : 0.07f));
    }
  }
  ImGui::PopFont();
}

void write_below(PanelContext& context, const PlotFrame& f, const std::string& left,
                 const std::string& right) {
  ImGui::PushFont(context.host.fonts().small);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float y = f.end.y - ImGui::GetTextLineHeight() - 1;
  list.AddText({f.x0, y}, palette::faint, left.c_str());
  const float width = ImGui::CalcTextSize(right.c_str()).x;
  if (f.x0 + ImGui::CalcTextSize(left.c_str()).x + 8 < f.x1 - width)
    list.AddText({f.x1 - width, y}, palette::faint, right.c_str());
  ImGui::PopFont();
}

void go_to_time(PanelContext& context, double time) {
  context.ask(GoToMoment{context.model.clock->tick_at(time)});
}

/// Index of the sample nearest to a time; none for an empty curve.
std::optional<size_t> sample_at(std::span<const double> at, double time) {
  if (at.empty()) return std::nullopt;
  const auto after = std::ranges::lower_bound(at, time);
  if (after == at.begin()) return 0;
  const auto before = std::prev(after);
  const bool later = after != at.end() && *after - time < time - *before;
  return size_t((later ? after : before) - at.begin());
}

/// Shows time and values under the pointer; a click seeks to that time.
void read_over_time(PanelContext& context, std::span<const PlottedCurve> curves, const PlotFrame& f,
                    double from, double to) {
  if (!ImGui::IsItemHovered() || !(to > from)) return;
  const float x = std::clamp(ImGui::GetIO().MousePos.x, f.x0, f.x1);
  double time = from + double((x - f.x0) / (f.x1 - f.x0)) * (to - from);
  const auto nearest = sample_at(curves[0].at, time);
  if (nearest) time = curves[0].at[*nearest];
  std::string text = fmt::format("{:.3f} s", time);
  for (const PlottedCurve& curve : curves)
    if (const auto i = sample_at(curve.at, time))
      text +=
          fmt::format("\n{}: {}", curve.label, quantity_text(double(curve.values[*i]), curve.unit));
  const float line = f.x((time - from) / (to - from));
  ImGui::GetWindowDrawList()->AddLine({line, f.y0}, {line, f.y1},
                                      palette::faded(palette::text, 0.5f));
  ImGui::SetTooltip("%s", text.c_str());
  if (ImGui::IsMouseClicked(0)) go_to_time(context, time);
}

/// A pair of values at a time that both curves have.
struct PhasePoint {
  double time;
  float x, y;
};
std::vector<PhasePoint> pairs_of(const PlottedCurve& across, const PlottedCurve& up) {
  std::vector<PhasePoint> out;
  for (size_t i = 0, k = 0; i < across.at.size() && k < up.at.size();) {
    if (across.at[i] < up.at[k])
      ++i;
    else if (up.at[k] < across.at[i])
      ++k;
    else {
      if (std::isfinite(across.values[i]) && std::isfinite(up.values[k]))
        out.push_back({across.at[i], across.values[i], up.values[k]});
      ++i, ++k;
    }
  }
  return out;
}

}  // namespace

double round_step(double range, double lines) {
  const double raw = range / lines;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw) return m * power;
  return 10 * power;
}

void plot_over_time(PanelContext& context, std::string_view name,
                    std::span<const PlottedCurve> curves, float height) {
  if (curves.empty()) return;
  PlotFrame f = begin_plot(context, name, height);
  std::vector<size_t> axis_of;
  std::vector<Axis> axes = axes_of(curves, std::max(double(f.y0 - f.y1) / 34, 1.0), axis_of);
  draw_value_axes(context, axes, f);
  double from = std::numeric_limits<double>::infinity(), to = -from;
  for (const PlottedCurve& curve : curves)
    if (!curve.at.empty()) {
      from = std::min(from, curve.at.front());
      to = std::max(to, curve.at.back());
    }
  if (!(from <= to)) return;
  const double length = std::max(to - from, 1e-12);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect({f.x0, f.at.y}, {f.x1 + 1, f.end.y}, true);
  for (size_t c = 0; c < curves.size(); ++c) {
    const size_t n = std::min(curves[c].at.size(), curves[c].values.size());
    for (size_t i = 0; i < n; ++i)
      if (std::isfinite(curves[c].values[i]))
        list.PathLineTo({f.x((curves[c].at[i] - from) / length),
                         f.y(axes[axis_of[c]].share(double(curves[c].values[i])))});
    list.PathStroke(curves[c].colour, 0, 1.6f);
  }
  const double now = context.model.frame->time;
  if (now >= from && now <= to && to > from) {
    const float x = f.x((now - from) / length);
    list.AddLine({x, f.y0}, {x, f.y1}, palette::accent);
  }
  list.PopClipRect();
  write_below(context, f, fmt::format("{:.2f} s", from), fmt::format("{:.2f} s", to));
  read_over_time(context, curves, f, from, to);
}

void plot_phase(PanelContext& context, std::string_view name, const PlottedCurve& across,
                const PlottedCurve& up, float height) {
  PlotFrame f = begin_plot(context, name, height);
  const Axis y = axis_over(std::span(&up, 1), std::max(double(f.y0 - f.y1) / 34, 1.0));
  draw_value_axes(context, std::span(&y, 1), f);
  const Axis x = axis_over(std::span(&across, 1), std::max(double(f.x1 - f.x0) / 80, 1.0));
  const std::vector<PhasePoint> points = pairs_of(across, up);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto place = [&](const PhasePoint& p) {
    return ImVec2(f.x(x.share(double(p.x))), f.y(y.share(double(p.y))));
  };
  const auto lines = int(std::lround((x.high - x.low) / x.step));
  for (int k = 0; k <= lines; ++k) {
    const float at = f.x(double(k) / std::max(lines, 1));
    list.AddLine({at, f.y0}, {at, f.y1}, palette::faded(palette::text, 0.07f));
  }
  list.PushClipRect({f.x0, f.at.y}, {f.x1 + 1, f.end.y}, true);
  for (const PhasePoint& p : points) list.PathLineTo(place(p));
  list.PathStroke(up.colour, 0, 1.6f);
  list.PopClipRect();
  write_below(context, f, round_text(x.low, across.unit), round_text(x.high, across.unit));
  if (points.empty()) return;
  const double now = context.model.frame->time;
  const auto shown = std::ranges::min_element(
      points, {}, [&](const PhasePoint& p) { return std::abs(p.time - now); });
  list.AddCircleFilled(place(*shown), 4, palette::accent);
  if (!ImGui::IsItemHovered()) return;
  const ImVec2 pointer = ImGui::GetIO().MousePos;
  const auto nearest = std::ranges::min_element(points, {}, [&](const PhasePoint& p) {
    const ImVec2 at = place(p);
    return std::hypot(at.x - pointer.x, at.y - pointer.y);
  });
  list.AddCircle(place(*nearest), 5, palette::text);
  ImGui::SetTooltip("%s", fmt::format("{:.3f} s\n{}: {}\n{}: {}", nearest->time, across.label,
                                      quantity_text(double(nearest->x), across.unit), up.label,
                                      quantity_text(double(nearest->y), up.unit))
                              .c_str());
  if (ImGui::IsMouseClicked(0)) go_to_time(context, nearest->time);
}

}  // namespace tumble
