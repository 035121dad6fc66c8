#pragma once
#include "engine/collision/v_clip/v_clip.hpp"

namespace tumble::vclip {

/// One of the two polyhedra, and the transform from its body frame to the other's.
struct Side {
  const VoronoiPolyhedron* model = nullptr;
  Mat3 R;
  Vec3 t;

  Vec3 to_other(const Vec3& p) const { return R * p + t; }
  Vec3 turn(const Vec3& d) const { return R * d; }
};

/// The end of a walk: nearest points of the two features, in the body frame of side `frame`.
struct Answer {
  size_t frame = 0;
  std::array<Vec3, 2> points;  ///< on A, on B
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B
  double distance = 0;         ///< [m]
  /// Upper bound, as far as the tests at the features can tell, of how far the two polyhedra extend
  /// beyond the planes with normal `normal` through the points [m]: the error of the distance is at
  /// most this, divided by the sine of the straightest corner.
  double overshoot = 0;
};

/// The walk over pairs of features.
struct Walk {
  std::array<Side, 2> side;  ///< A, B
  ClosestFeatures at;
  Vec3 centres;      ///< from A's centre to B's, frame 0
  double apart = 0;  ///< their distance [m]
  double scale = 0;  ///< diameters and distance of the centres [m]
  double reach = 0;  ///< sum of the diameters [m]
  /// Rounding error of a signed distance; a plane is violated only beyond it [m].
  double epsilon = 0;
  double touching = 0;  ///< distances up to this count as contact [m]
  Answer found;
};

enum class Move {
  onward,       ///< `at` has changed
  arrived,      ///< `found` is the result
  penetrating,  ///< the bodies overlap; `at` is where this was detected
};

/// The five states; `v` and `e` are the side (0 or 1) that has the vertex or the edge.
Move vertex_vertex(Walk& walk);
Move vertex_edge(Walk& walk, size_t v);
Move vertex_face(Walk& walk, size_t v);
Move edge_edge(Walk& walk);
Move edge_face(Walk& walk, size_t e);

/// Decides the result for features that meet within the tolerance: `arrived` with the normal of a
/// plane that separates the cones of the two features, or `penetrating` if there is none.
Move judge_touching(Walk& walk);

/// Finds the result without a walk: GJK gives a separating plane, and all pairs of features that
/// reach into the slab in which the nearest points must be are compared. Cannot cycle.
Move search_all(Walk& walk);

}  // namespace tumble::vclip
