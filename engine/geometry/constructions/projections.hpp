#pragma once
#include "engine/math/types.hpp"

#include <optional>

namespace tumble {

/// The points x with normal.dot(x) = offset; normal is a unit vector that points outside.
struct Plane {
  Vec3 normal = Vec3::UnitY();
  double offset = 0;  ///< [m]

  /// Signed distance of `p` [m], positive outside.
  double distance(const Vec3& p) const { return normal.dot(p) - offset; }
};

/// The plane through three points, counter-clockwise seen from outside; nothing when they are
/// collinear.
std::optional<Plane> plane_through(const Vec3& a, const Vec3& b, const Vec3& c);

/// Nearest point of the plane (Coutinho §6.2).
Vec3 project_on_plane(const Vec3& p, const Plane& plane);
/// The part of `v` that lies in planes across the unit vector `n`.
Vec3 reject(const Vec3& v, const Vec3& n);
/// Nearest point of the infinite line through `origin` along `direction` (any length; the zero
/// vector makes the line a point and gives `origin`).
Vec3 project_on_line(const Vec3& p, const Vec3& origin, const Vec3& direction);

/// Where segment a-b meets the plane, as s in [0, 1] with the point a + s (b - a). Nothing when
/// both ends lie strictly on one side. When the whole segment lies in the plane s is 0.
std::optional<double> segment_plane(const Vec3& a, const Vec3& b, const Plane& plane);

}  // namespace tumble
