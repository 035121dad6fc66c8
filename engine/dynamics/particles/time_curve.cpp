#include "engine/dynamics/particles/time_curve.hpp"

#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr double never = std::numeric_limits<double>::infinity();

/// Of a straight piece that begins with a value and rises with a slope, over x seconds.
double piece(double value, double slope, double x) {
  return slope == 0 ? value * x : value * x + 0.5 * slope * x * x;
}

/// After how long it is so much: the root of the quadratic without cancellation.
double time_in_piece(double value, double slope, double area) {
  if (!(area > 0)) return 0;
  const double root = std::sqrt(std::max(0.0, value * value + 2 * slope * area));
  return value + root > 0 ? 2 * area / (value + root) : never;
}

/// Calls f(begin, end, value, slope) for every piece from a time on, in their order, until f says
/// that it is enough. The last one has no end.
template <class F>
void for_pieces(const FactorCurve& curve, double from, const F& f) {
  double begin = from;
  for (const auto& p : curve.points) {
    if (p.time <= begin) continue;
    const double value = curve.at(begin);
    if (f(begin, p.time, value, (p.value - value) / (p.time - begin))) return;
    begin = p.time;
  }
  f(begin, never, curve.at(begin), 0.0);
}

}  // namespace

double FactorCurve::least() const {
  double out = points.empty() ? 1 : points[0].value;
  for (const Point& p : points) out = std::min(out, p.value);
  return out;
}

double FactorCurve::most() const {
  double out = points.empty() ? 1 : points[0].value;
  for (const Point& p : points) out = std::max(out, p.value);
  return out;
}

double FactorCurve::integral(double from, double to) const {
  double sum = 0;
  for_pieces(*this, from, [&](double begin, double end, double value, double slope) {
    if (to <= begin) return true;
    const double until = std::min(to, end);
    if (value != 0 || slope != 0) sum += piece(value, slope, until - begin);
    return to <= end;
  });
  return sum;
}

double FactorCurve::time_of_integral(double from, double area) const {
  double out = never, left = area;
  for_pieces(*this, from, [&](double begin, double end, double value, double slope) {
    const bool last = end == never;
    const double all = last ? (value > 0 ? never : 0) : piece(value, slope, end - begin);
    if (left > all) {
      left -= all;
      return false;
    }
    const double x = time_in_piece(value, slope, left);
    out = last ? begin + x : std::min(begin + x, end);
    return true;
  });
  return out;
}

}  // namespace tumble
