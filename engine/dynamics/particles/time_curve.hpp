#pragma once
#include "engine/math/types.hpp"

#include <algorithm>
#include <vector>

namespace tumble {

/// A value over time: straight between its points, constant before the first and after the last.
template <class T>
struct TimeCurve {
  struct Point {
    double time = 0;  ///< [s]
    T value{};
  };
  std::vector<Point> points;  ///< of ascending times; none: the curve says nothing

  bool empty() const { return points.empty(); }
  /// `otherwise` where the curve says nothing.
  T at(double time, const T& otherwise) const {
    if (points.empty()) return otherwise;
    const auto after = std::ranges::upper_bound(points, time, {}, &Point::time);
    if (after == points.begin()) return points.front().value;
    if (after == points.end()) return points.back().value;
    const Point& before = *(after - 1);
    const double u = (time - before.time) / (after->time - before.time);
    return mixed(before.value, after->value, u);
  }

 private:
  static double mixed(double a, double b, double u) { return a + u * (b - a); }
  static Vec3f mixed(const Vec3f& a, const Vec3f& b, double u) { return a + float(u) * (b - a); }
};

/// Factors of a number over time; without points 1.
struct FactorCurve : TimeCurve<double> {
  double at(double time) const { return TimeCurve::at(time, 1.0); }
  double least() const;
  double most() const;
  /// Integral from one time to a later one, which may be infinite [s].
  double integral(double from, double to) const;
  /// When the integral from a time is so much; infinite where it never is. No factor is negative.
  double time_of_integral(double from, double area) const;
};

}  // namespace tumble
