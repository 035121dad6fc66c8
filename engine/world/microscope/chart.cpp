#include "engine/world/microscope/chart.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

struct ChartMargins {
  static constexpr double left = 0.06, right = 0.06, bottom = 0.12, top = 0.1;
};

}  // namespace

Chart::Chart(Diagram& out, double x0, double x1, double y0, double y1, std::string x_label,
             std::string y_label)
    : out_(out), x0_(x0), x1_(x1 > x0 ? x1 : x0 + 1), y0_(y0), y1_(y1 > y0 ? y1 : y0 + 1) {
  const Vec2 origin = at(x0_, y0_);
  out_.lines.push_back({origin, at(x1_, y0_), Ink::plain, 1.5f, true});
  out_.lines.push_back({origin, at(x0_, y1_), Ink::plain, 1.5f, true});
  out_.labels.push_back({{at(x1_, y0_).x(), 0}, std::move(x_label), Ink::plain, {1, 0}});
  out_.labels.push_back({{origin.x(), 1}, std::move(y_label), Ink::plain, {0, 1}});
}

Vec2 Chart::at(double x, double y) const {
  const double u = std::clamp((x - x0_) / (x1_ - x0_), 0.0, 1.0);
  const double v = std::clamp((y - y0_) / (y1_ - y0_), 0.0, 1.0);
  using M = ChartMargins;
  return {M::left + u * (out_.aspect - M::left - M::right),
          M::bottom + v * (1 - M::bottom - M::top)};
}

void Chart::curve(const std::vector<Vec2>& points, Ink ink, float width) {
  for (size_t i = 1; i < points.size(); ++i) line(points[i - 1], points[i], ink, width);
}
void Chart::line(const Vec2& a, const Vec2& b, Ink ink, float width) {
  out_.lines.push_back({at(a.x(), a.y()), at(b.x(), b.y()), ink, width, false});
}
void Chart::point(const Vec2& p, Ink ink, float size) {
  out_.points.push_back({at(p.x(), p.y()), ink, size});
}
void Chart::band(double a, double b, Ink ink, float opacity) {
  out_.boxes.push_back({at(a, y0_), at(b, y1_), ink, opacity});
}

}  // namespace tumble
