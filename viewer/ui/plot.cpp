#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

/// The least of 1, 2, 5 times a power of ten of which at most `lines` fit into `range`.
double round_step(double range, double lines) {
  const double raw = range / lines;
  const double power = std::pow(10.0, std::floor(std::log10(raw)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= raw) return m * power;
  return 10 * power;
}

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
  const double size = r.high - r.low;
  if (size < 1e-9) return {r.low - 0.5, r.high + 0.5};
  return {r.low - (r.low < 0 ? 0.06 * size : 0), r.high + 0.06 * size};
}

}  // namespace

void plot(PanelContext& context, std::string_view name, std::span<const Curve> curves, float height,
          std::string_view unit) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::Dummy(ImVec2(width, height));
  context.host.mark(name);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImVec2 end(at.x + width, at.y + height);
  list.AddRectFilled(at, end, palette::rgba(0x000000, 0.25f), 5);
  const Range range = range_of(curves);
  const auto y_of = [&](double v) {
    return float(end.y - 3 - (v - range.low) / (range.high - range.low) * (height - 6));
  };
  list.PushClipRect(at, end, true);
  const double step = round_step(range.high - range.low, std::max(double(height) / 30, 1.0));
  ImFont* font = context.host.fonts().small;
  const float size = font->FontSize * float(1 / context.host.scale());
  for (double v = std::ceil(range.low / step) * step; v <= range.high; v += step) {
    const float y = y_of(v);
    const bool zero = std::abs(v) < 0.01 * step;
    list.AddLine({at.x, y}, {end.x, y}, palette::rgba(0xFFFFFF, zero ? 0.22f : 0.07f));
    if (y - size > at.y + 2)
      list.AddText(font, size, {at.x + 6, y - size - 1}, palette::faint,
                   zero ? "0" : quantity_text(v, unit).c_str());
  }
  for (const Curve& curve : curves) {
    const size_t n = curve.values.size();
    for (size_t i = 0; i < n; ++i) {
      const float x = at.x + width * (float(i) / float(std::max<size_t>(n - 1, 1)));
      list.PathLineTo({x, y_of(double(curve.values[i]))});
    }
    if (n > 1)
      list.PathStroke(curve.colour, 0, 1.6f);
    else
      list.PathClear();
  }
  list.PopClipRect();
}

}  // namespace tumble
