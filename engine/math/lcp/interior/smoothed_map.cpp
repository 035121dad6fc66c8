#include "engine/math/lcp/interior/smoothed_map.hpp"

#include "engine/math/lcp/tolerances.hpp"

#include <algorithm>
#include <cmath>

namespace tumble::lcp {
namespace {

/// g(v) and its derivative.
struct Smooth {
  double value, slope;
};

Smooth positive_part(double v, double t) {
  const double root = std::sqrt(v * v + 4 * t * t);
  if (!(root > 0)) return {0, 0.5};
  // The smaller of the two roots of g (g - v) = t^2, computed from the greater one.
  const double greater = 0.5 * (root + std::fabs(v));
  const double smaller = t * t / greater;
  return v > 0 ? Smooth{greater, greater / root} : Smooth{smaller, smaller / root};
}

/// v clamped to [lower, upper], smoothly; derivatives by v and by the two bounds.
struct Clamped {
  double value, by_v, by_lower, by_upper;
};

Clamped clamped(double v, double lower, double upper, double t) {
  Clamped out{v, 1, 0, 0};
  if (std::isfinite(lower)) {
    const Smooth g = positive_part(v - lower, t);
    out.value += lower - v + g.value;
    out.by_v = g.slope;
    out.by_lower = 1 - g.slope;
  }
  if (std::isfinite(upper)) {
    const Smooth passed = positive_part(v - upper, t);
    out.value -= passed.value;
    out.by_v -= passed.slope;
    out.by_upper = passed.slope;
  }
  return out;
}

/// g of v = (v0, v1, v2) in the algebra of the second-order cone, and its derivative.
void cone_part(const Triple& v, double t, Triple& value, Square& slope) {
  const double length = std::sqrt(v[1] * v[1] + v[2] * v[2]);
  const double c = length > 0 ? v[1] / length : 1, s = length > 0 ? v[2] / length : 0;
  const Smooth low = positive_part(v[0] - length, t), high = positive_part(v[0] + length, t);
  const double half_sum = 0.5 * (low.value + high.value);
  const double half_difference = 0.5 * (high.value - low.value);
  value = {half_sum, half_difference * c, half_difference * s};
  const double mean = 0.5 * (low.slope + high.slope), tilt = 0.5 * (high.slope - low.slope);
  const double across = length > tolerances::smoothed_axis * t ? half_difference / length : mean;
  slope = {mean,
           tilt * c,
           tilt * s,  //
           tilt * c,
           across + (mean - across) * c * c,
           (mean - across) * c * s,
           tilt * s,
           (mean - across) * c * s,
           across + (mean - across) * s * s};
}

/// `rounding` is the value of the smoothed |w_t| at w_t = 0.
void add_circular(const ConeGroup& g, const Triple& z, const Triple& w, double t, double rounding,
                  UnitValue& out) {
  const double length = std::sqrt(w[1] * w[1] + w[2] * w[2] + rounding * rounding);
  const double c = length > 0 ? w[1] / length : 0, s = length > 0 ? w[2] / length : 0;
  const Triple x{g.slope * z[0], z[1], z[2]};
  const Triple y{w[0] / g.slope + length, w[1], w[2]};
  Triple part;
  Square S;
  cone_part({x[0] - y[0], x[1] - y[1], x[2] - y[2]}, t, part, S);
  for (size_t r = 0; r < 3; ++r) {
    out.f[r] = x[r] - part[r];
    for (size_t q = 0; q < 3; ++q)
      out.by_z[3 * r + q] = ((r == q ? 1 : 0) - S[3 * r + q]) * (q == 0 ? g.slope : 1);
    out.by_w[3 * r] = S[3 * r] / g.slope;
    out.by_w[3 * r + 1] = S[3 * r] * c + S[3 * r + 1];
    out.by_w[3 * r + 2] = S[3 * r] * s + S[3 * r + 2];
  }
}

/// Function and derivatives for the first unknown of a unit, with bounds.
void add_single(const ConeUnit& unit, double z, double w, double t, UnitValue& out) {
  if (unit.lower == unit.upper) {
    out.f[0] = z - unit.lower;
    out.by_z[0] = 1;
    return;
  }
  const Clamped to = clamped(z - w, unit.lower, unit.upper, t);
  out.f[0] = z - to.value;
  out.by_z[0] = 1 - to.by_v;
  out.by_w[0] = to.by_v;
}

}  // namespace

UnitValue smoothed_value(const ConeUnit& unit, const Triple& z, const Triple& w, double t,
                         double scale) {
  UnitValue out;
  if (!unit.group) {
    add_single(unit, z[0], w[0], t, out);
    return out;
  }
  const ConeGroup& g = *unit.group;
  if (g.mode == ConeMode::undecided && g.shape == ConeShape::circular &&
      g.slope > tolerances::flat_cone) {
    add_circular(g, z, w, t, t * t / scale, out);
    return out;
  }
  add_single(unit, z[0], w[0], t, out);
  for (size_t k = 0; k < 2; ++k) {
    const size_t r = k + 1;
    if (g.mode == ConeMode::sliding || g.slope <= tolerances::flat_cone) {
      const double part = g.mode == ConeMode::sliding ? g.slope * g.direction[k] : 0;
      out.f[r] = z[r] + part * z[0];
      out.by_z[3 * r] = part;
      out.by_z[4 * r] = 1;
      continue;
    }
    const double radius = g.slope * z[0];
    const Clamped to = clamped(z[r] - w[r], -radius, radius, t);
    out.f[r] = z[r] - to.value;
    out.by_z[4 * r] = 1 - to.by_v;
    out.by_w[4 * r] = to.by_v;
    out.by_z[3 * r] = g.slope * (to.by_lower - to.by_upper);
  }
  return out;
}

}  // namespace tumble::lcp
