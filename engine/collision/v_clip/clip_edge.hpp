#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <limits>

namespace tumble::vclip {

/// The part of an edge e(lambda), lambda in [0, 1], inside a Voronoi region, and the neighbours of
/// the region's feature whose planes clipped its ends (Mirtich 1998, clipEdge).
struct ClippedEdge {
  static constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

  double min = 0, max = 1;
  uint32_t min_neighbour = none;  ///< where e enters the region; none if its tail is inside
  uint32_t max_neighbour = none;  ///< where e leaves it; none if its head is inside
  bool simply_excluded = false;   ///< all of e is behind the plane of `min_neighbour`

  /// Clips by the plane towards `neighbour`, given the signed distances of tail and head, positive
  /// on the region's side. False if nothing is left.
  bool cut(double tail, double head, uint32_t neighbour) {
    if (tail < 0 && head < 0) {
      min_neighbour = max_neighbour = neighbour;
      simply_excluded = true;
      return false;
    }
    if (tail < 0) {
      const double lambda = tail / (tail - head);
      if (lambda > min) {
        min = lambda;
        min_neighbour = neighbour;
      }
    } else if (head < 0) {
      const double lambda = tail / (tail - head);
      if (lambda < max) {
        max = lambda;
        max_neighbour = neighbour;
      }
    }
    return min <= max;
  }
};

/// Nearest points a + s u and b + t v of two segments with unit directions and these lengths. The
/// distance is exact up to rounding even for nearly parallel lines, for which s and t are
/// inaccurate.
struct SegmentsNearest {
  double s = 0, t = 0;      ///< [m]
  Vec3 gap = Vec3::Zero();  ///< from the point on the first to the point on the second
};
SegmentsNearest nearest_of_segments(const Vec3& a, const Vec3& u, double length_a, const Vec3& b,
                                    const Vec3& v, double length_b);

}  // namespace tumble::vclip
