#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Shape of a surface near a contact, simple enough for a gap function with exact derivatives.
enum class ElementKind : uint8_t {
  point,   ///< a corner, or a ball about a point
  line,    ///< an edge, or a cylinder about an axis
  plane,   ///< a face
  circle,  ///< the rim of a cap
  ellipsoid,
  cone,  ///< a surface of revolution with a radius that changes linearly along its axis
};

/// An element of a surface, in the frame of its shape or (`dynamics/contact/surface/`) of its body.
struct SurfaceElement {
  ElementKind kind = ElementKind::point;
  /// The point itself, a point of the line, plane or cone's axis, or the centre of the circle or
  /// ellipsoid.
  Vec3 origin = Vec3::Zero();
  /// Unit: the outward normal of a plane, the direction of a line, the axis of a circle or cone.
  Vec3 direction = Vec3::UnitY();
  /// Radius of the rounding about a point or line, of a circle, or of the ball with its centre at
  /// `origin` that touches a cone from inside [m].
  double radius = 0;
  Mat3 semi_axes = Mat3::Zero();  ///< of an ellipsoid, as columns [m]
  double taper = 0;  ///< of a cone: change of that radius per length along its axis [-]
};

/// A material point of a surface.
inline SurfaceElement material_point(const Vec3& point) {
  return {ElementKind::point, point, Vec3::UnitY(), 0};
}

/// A normal within this angle of a face's normal counts as parallel to it [rad].
constexpr double element_parallel = 1e-6;
/// A point nearer than this to a corner, edge or rim is on it; relative to the size of the shape.
constexpr double element_close_by = 1e-6;

/// Whether two unit vectors are parallel within `element_parallel`.
inline bool element_along(const Vec3& a, const Vec3& b) {
  return a.dot(b) > 0 && a.cross(b).norm() <= element_parallel;
}

}  // namespace tumble
