#pragma once
#include "engine/collision/shape.hpp"

#include <span>

namespace tumble {

// What solids that are round about y have in common.

/// The side of a truncated cone about y: its radius runs from `r0` at `y0` to `r1` at `y1` > `y0`.
struct ConeSide {
  double y0, r0, y1, r1;
};
/// Where a ray first goes in through the side, if it does; own frame.
std::optional<RayHit> ray_cone_side(const ConeSide& side, const Ray& ray, double t_max);
/// What a ray that starts inside any solid hits.
RayHit hit_from_inside(const Ray& ray);

/// A ring of points of a surface of revolution, and how its normal leans.
struct ProfilePoint {
  double y, radius;             ///< [m]
  double normal_y, normal_out;  ///< unit
};
/// The surface from the bottom to the top; two points in one place make a sharp edge.
DrawnSurface turned_surface(std::span<const ProfilePoint> profile, uint32_t around);

}  // namespace tumble
