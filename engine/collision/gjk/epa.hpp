#pragma once
#include "engine/collision/gjk/gjk.hpp"

#include <array>
#include <vector>

namespace tumble {

struct EpaResult {
  /// Unit; moving B by `depth` along it separates the cores (shortest such move found).
  Vec3 normal = Vec3::UnitY();
  double depth = 0;        ///< an upper bound on the penetration depth, attained by `normal` [m]
  double lower_bound = 0;  ///< the true depth is between this and `depth` [m]
  Vec3 a = Vec3::Zero();   ///< point of A's core deepest in B, query frame
  Vec3 b = Vec3::Zero();
  int iterations = 0;
  bool converged = false;  ///< the bounds met within the tolerance
};

/// The polytope before each expansion, for drawing; null costs one test per expansion. All in A's
/// frame.
struct EpaStage {
  std::vector<std::array<Vec3, 3>> faces;  ///< counter-clockwise seen from outside
  size_t nearest = 0;                      ///< the face nearest to the origin
  Vec3 normal = Vec3::Zero();              ///< of that face: unit, outward
  Vec3 support = Vec3::Zero();             ///< the point of the difference furthest along it
  double lower = 0, upper = 0;             ///< the depth is between these [m]
};
using EpaTrace = std::vector<EpaStage>;

/// Depth and direction of penetration of two cores that gjk() found to intersect: the expanding
/// polytope algorithm (van den Bergen, "Proximity queries and penetration depth computation on 3D
/// game objects", 2001). `start` is gjk()'s simplex. A polytope inside the difference is expanded
/// at the face nearest to the origin, whose distance is a lower bound of the depth, until it meets
/// the support plane along that face's normal, an upper bound: within 2e-13 of the scale for
/// polyhedra (with exact supports, and a hull whose decisions are right, polytope.hpp), and for
/// curved cores also within `relative_tolerance` of the depth.
/// In every case the result is safe: `depth` is the support of the difference along `normal`, so
/// the move always separates. A difference without volume (two parallel flat cores) has depth 0
/// along its thin direction.
EpaResult epa(const PlacedCore& A, const PlacedCore& B, const Simplex& start,
              double relative_tolerance = 1e-9, EpaTrace* trace = nullptr);

}  // namespace tumble
