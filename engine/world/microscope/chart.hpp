#pragma once
#include "engine/world/microscope/sketch.hpp"

namespace tumble {

/// Curves over two axes, drawn into a diagram: the range [x0, x1] x [y0, y1] fills it, less a
/// margin for the labels of the axes.
class Chart {
 public:
  Chart(Diagram& out, double x0, double x1, double y0, double y1, std::string x_label,
        std::string y_label);

  Vec2 at(double x, double y) const;
  void curve(const std::vector<Vec2>& points, Ink ink, float width = 2);
  void line(const Vec2& a, const Vec2& b, Ink ink, float width = 1.5f);
  void point(const Vec2& p, Ink ink, float size = 7);
  /// A band over the full height, from x = a to x = b.
  void band(double a, double b, Ink ink, float opacity);

 private:
  Diagram& out_;
  double x0_, x1_, y0_, y1_;
};

}  // namespace tumble
