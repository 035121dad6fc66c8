#pragma once
#include "engine/collision/shape.hpp"

#include <span>

namespace tumble {

// Common parts of solids of revolution about y.

/// The side of a truncated cone about y: its radius runs from `r0` at `y0` to `r1` at `y1` > `y0`.
struct ConeSide {
  double y0, r0, y1, r1;
};
/// Where a ray first enters through the side, if it does; own frame.
std::optional<RayHit> ray_cone_side(const ConeSide& side, const Ray& ray, double t_max);
/// The hit of a ray that starts inside a solid.
RayHit hit_from_inside(const Ray& ray);

/// A ring of points of a surface of revolution, with the components of its normal.
struct ProfilePoint {
  double y, radius;             ///< [m]
  double normal_y, normal_out;  ///< unit
};
/// The surface from the bottom to the top; two equal points in sequence make a sharp edge.
DrawnSurface turned_surface(std::span<const ProfilePoint> profile, uint32_t around);

}  // namespace tumble
