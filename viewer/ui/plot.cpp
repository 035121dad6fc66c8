#include "viewer/ui/curve_plots.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <imgui.h>

namespace tumble {
namespace {

struct Range {
  double low = 0, high = 0;
};

Range range_of(std::span<const Curve> curves) {
  Range r{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Curve& curve : curves)
    for (const float v : curve.values)
      if (std::isfinite(v)) {
        r.low = std::min(r.low, double(v));
        r.high = std::max(r.high, double(v));
      }
  if (!(r.low <= r.high)) return {0, 1};
  r.low = std::min(r.low, 0.0);
  r.high = std::max(r.high, 0.0);
  if (r.high - r.low < 1e-9) return {r.low, r.low + 1};
  return r;
}

}  // namespace

void plot(PanelContext& context, std::string_view name, std::span<const double> abscissae,
          std::span<const Curve> curves, float height, std::string_view unit) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::Dummy(ImVec2(width, height));
  context.host.mark(name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + width, at.y + height);
  list.AddRectFilled(at, end, palette::well, 5);

  // Both ends are grid lines: the scale changes in steps, and every grid line has a label.
  ImGui::PushFont(context.host.fonts().small);
  const float line_height = ImGui::GetTextLineHeight();
  Range range = range_of(curves);
  const double step = round_step(range.high - range.low, std::max(double(height) / 34, 1.0));
  const double first = std::floor(range.low / step + 1e-9);
  const double last = std::ceil(range.high / step - 1e-9);
  range = {first * step, last * step};
  const float margin = 0.5f * line_height + 2;
  const auto y_of = [&](double v) {
    return float(double(end.y - margin) -
                 (v - range.low) / (range.high - range.low) * double(height - 2 * margin));
  };
  // Enough for most labels, so that the curves do not move when the scale changes.
  float label_width = 52;
  for (double k = first; k <= last; ++k)
    label_width = std::max(label_width, ImGui::CalcTextSize(round_text(k * step, unit).c_str()).x);
  const float x0 = at.x + 6, x1 = end.x - label_width - 12;
  for (double k = first; k <= last; ++k) {
    const float y = y_of(k * step);
    const std::string text = round_text(k * step, unit);
    list.AddLine({at.x, y}, {x1, y}, palette::faded(palette::text, k == 0 ? 0.22f : 0.07f));
    list.AddText({end.x - 6 - ImGui::CalcTextSize(text.c_str()).x, y - 0.5f * line_height},
                 palette::faint, text.c_str());
  }
  ImGui::PopFont();

  const double from = abscissae.empty() ? 0 : abscissae.front();
  const double length = abscissae.empty() ? 1 : std::max(abscissae.back() - from, 1e-12);
  list.PushClipRect({at.x, at.y}, {x1, end.y}, true);
  for (const Curve& curve : curves) {
    const size_t n = std::min(curve.values.size(), abscissae.size());
    for (size_t i = 0; i < n; ++i)
      if (std::isfinite(curve.values[i]))
        list.PathLineTo({x0 + (x1 - x0) * float((abscissae[i] - from) / length),
                         y_of(double(curve.values[i]))});
    if (n > 1)
      list.PathStroke(curve.colour, 0, 1.6f);
    else
      list.PathClear();
  }
  list.PopClipRect();
}

}  // namespace tumble
