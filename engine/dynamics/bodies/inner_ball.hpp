#pragma once
#include "engine/dynamics/bodies/bare_surface.hpp"

#include <vector>

namespace tumble {

/// A ball inside a body.
struct InnerBall {
  Vec3 centre;
  double radius;  ///< [m]
};

/// The largest ball about an inner point.
InnerBall ball_about(const BareSurface& surface, const Vec3& p);

/// The ball that the one about a point grows to as its centre moves away from the walls; stops
/// early at one of radius `enough`.
InnerBall grown_ball(const BareSurface& surface, const Vec3& p, double enough);

/// The shortest vector of the convex hull of up to `ball_walls` vectors.
Vec3 shortest_of_hull(const std::vector<Vec3>& vectors);

}  // namespace tumble
