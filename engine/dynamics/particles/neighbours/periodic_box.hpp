#pragma once
#include "engine/math/types.hpp"

#include <cmath>

namespace tumble {

/// A periodic box: what leaves through a face enters through the opposite one. It represents an
/// infinite lattice of copies.
struct PeriodicBox {
  Vec3 low = Vec3::Zero();   ///< least corner [m]
  Vec3 size = Vec3::Zero();  ///< edge lengths; 0 along axes that are not periodic [m]

  bool along(int axis) const { return size[axis] > 0; }
  bool any() const { return (size.array() > 0).any(); }
  bool operator==(const PeriodicBox&) const = default;

  /// The copy of a point that lies inside the box.
  Vec3 wrapped(Vec3 x) const {
    for (int k = 0; k < 3; ++k)
      if (along(k)) x[k] -= size[k] * std::floor((x[k] - low[k]) / size[k]);
    return x;
  }
  /// The shortest vector from a point to any copy of another one, given one of these vectors.
  Vec3 shortest(Vec3 d) const {
    for (int k = 0; k < 3; ++k)
      if (along(k)) d[k] -= size[k] * std::floor(d[k] / size[k] + 0.5);
    return d;
  }
};

}  // namespace tumble
