#include "engine/math/lcp/newton/natural_map.hpp"

#include "engine/math/lcp/cone.hpp"

#include <algorithm>

namespace tumble::lcp {

Triple natural_value(const ConeUnit& unit, const Triple& z, const Triple& w) {
  if (!unit.group) return {z[0] - std::clamp(z[0] - w[0], unit.lower, unit.upper), 0, 0};
  const double axial = std::max(0.0, z[0] - w[0]);
  const auto to = nearest_lateral(*unit.group, axial, {z[1] - w[1], z[2] - w[2]});
  return {z[0] - axial, z[1] - to[0], z[2] - to[1]};
}

void set_natural_slope(const ConeUnit& unit, const Triple& z, const Triple& w, UnitValue& out) {
  out.by_z = {}, out.by_w = {};
  const auto still = [&](size_t r) { out.by_z[4 * r] = 1; };
  const auto equation = [&](size_t r) { out.by_w[4 * r] = 1; };
  const double axial = z[0] - w[0];
  if (!unit.group) return axial > unit.lower && axial < unit.upper ? equation(0) : still(0);
  if (axial <= 0) {
    for (size_t r = 0; r < 3; ++r) still(r);
    return;
  }
  equation(0);
  // F_t = z_t - P(slope (z_a - w_a), z_t - w_t)
  const ConeGroup& g = *unit.group;
  const double radius = g.slope * axial;
  const std::array<double, 2> t{z[1] - w[1], z[2] - w[2]};
  const double length = std::sqrt(t[0] * t[0] + t[1] * t[1]);
  for (size_t k = 0; k < 2; ++k) {
    const size_t r = k + 1;
    const auto slides = [&](double u) {  // F_t = z_t - u slope (z_a - w_a)
      out.by_z[4 * r] = 1;
      out.by_z[3 * r] = -g.slope * u;
      out.by_w[3 * r] = g.slope * u;
    };
    if (g.mode == ConeMode::sliding) {
      slides(-g.direction[k]);
    } else if (g.shape == ConeShape::pyramid) {
      std::fabs(t[k]) <= radius ? equation(r) : slides(t[k] > 0 ? 1 : -1);
    } else if (length <= radius) {
      equation(r);
    } else {
      const double f = radius / length, u = t[k] / length, v = t[1 - k] / length;
      const size_t other = 3 * r + 2 - k;
      slides(u);
      out.by_z[4 * r] = 1 - f * (1 - u * u), out.by_w[4 * r] = f * (1 - u * u);
      out.by_z[other] = f * u * v, out.by_w[other] = -f * u * v;
    }
  }
}

}  // namespace tumble::lcp
