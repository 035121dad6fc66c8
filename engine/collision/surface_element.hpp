#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// What a surface is like near a contact, simple enough to have a gap with exact derivatives.
enum class ElementKind : uint8_t {
  point,   ///< a corner, or a ball about a point
  line,    ///< an edge, or what is round about an axis
  plane,   ///< a face
  circle,  ///< the rim of a cap
  ellipsoid,
  cone,  ///< what is round about an axis, with a radius that changes evenly along it
};

/// A piece of a surface, in the frame of its shape or (`dynamics/contact/surface/`) of its body.
struct SurfaceElement {
  ElementKind kind = ElementKind::point;
  /// Of the point, a point of the line or plane, the circle's or the ellipsoid's centre.
  Vec3 origin = Vec3::Zero();
  /// Plane: outward normal. Line: along it. Circle or cone: its axis. Unit.
  Vec3 direction = Vec3::UnitY();
  /// Of what is round about a point or a line, of the circle, or of the ball in a cone that touches
  /// it from inside and has its centre at `origin` [m].
  double radius = 0;
  Mat3 semi_axes = Mat3::Zero();  ///< of an ellipsoid, as columns [m]
  double taper = 0;  ///< of a cone: growth of that radius per length along its axis [-]
};

/// A material point of a surface.
inline SurfaceElement material_point(const Vec3& point) {
  return {ElementKind::point, point, Vec3::UnitY(), 0};
}

/// Normals within this angle of a face's count as across it [rad].
constexpr double element_parallel = 1e-6;
/// What is nearer than this to a corner, an edge or a rim is on it; of the size of the shape.
constexpr double element_close_by = 1e-6;

/// Whether two unit vectors point the same way, by `element_parallel`.
inline bool element_along(const Vec3& a, const Vec3& b) {
  return a.dot(b) > 0 && a.cross(b).norm() <= element_parallel;
}

}  // namespace tumble
