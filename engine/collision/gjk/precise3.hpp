#pragma once
#include "engine/math/double_double.hpp"
#include "engine/math/triple.hpp"

#include <cmath>

namespace tumble {

/// Rounding error of a vanishing difference in double-double arithmetic, relative to its terms.
constexpr double precise_noise = 1e-29;

using Precise3 = Triple<DoubleDouble>;

inline Precise3 precise(const Plain3& v) {
  return {{v.x, 0}, {v.y, 0}, {v.z, 0}};
}

/// (b - a) x (c - a).
inline Precise3 precise_normal(const Plain3& a, const Plain3& b, const Plain3& c) {
  const Precise3 o = precise(a);
  return (precise(b) - o).cross(precise(c) - o);
}

/// Six times the volume of the tetrahedron a, b, c, p: positive when p is on the side from which a,
/// b, c run counter-clockwise; 0 if it is below the rounding error.
inline double precise_volume(const Plain3& a, const Plain3& b, const Plain3& c, const Plain3& p) {
  const Precise3 n = precise_normal(a, b, c), d = precise(p) - precise(a);
  const double volume = n.dot(d).high;
  const double size = std::sqrt((b - a).squared() * (c - a).squared() * (p - a).squared());
  return std::abs(volume) > precise_noise * size ? volume : 0;
}

}  // namespace tumble
