#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <vector>

namespace tumble::assets {

/// A closed triangle surface, counter-clockwise seen from outside. Every coordinate is a whole
/// number of micrometres, or written in full: what is audited is exactly what is written.
struct Mesh {
  std::vector<Vec3> vertices;  ///< [m]
  std::vector<std::array<int, 3>> triangles;
};

/// A planar point: (u, w) of a cross-section or (radius, height) of a profile, [m].
struct Point2 {
  double u = 0;
  double w = 0;
};
using Loop2 = std::vector<Point2>;
using Loop3 = std::vector<Vec3>;

}  // namespace tumble::assets
