#pragma once
#include "engine/dynamics/bodies/body.hpp"

namespace tumble {

/// What a surface is like near a contact, simple enough to have a gap with exact derivatives.
enum class ElementKind : uint8_t {
  point,   ///< a corner, or a ball about a point
  line,    ///< an edge, or what is round about an axis
  plane,   ///< a face
  circle,  ///< the rim of a cap
  ellipsoid,
};

/// A piece of a body's surface in its frame (origin at the centre of mass, body axes).
struct SurfaceElement {
  ElementKind kind = ElementKind::point;
  /// Of the point, a point of the line or plane, the circle's or the ellipsoid's centre.
  Vec3 origin = Vec3::Zero();
  /// Plane: outward normal. Line: along it. Circle: its axis. Unit.
  Vec3 direction = Vec3::UnitY();
  double radius = 0;  ///< of what is round about a point or a line, or of the circle [m]
  Mat3 semi_axes = Mat3::Zero();  ///< of an ellipsoid, as columns [m]
};

/// The element of a shape of a body at a point of its surface where `outward` (unit) points out of
/// the body; both in the body's frame. A face counts as a plane where its normal is within 1e-6 rad
/// of `outward`; else an edge, a corner or the furthest point of a rim within 1e-6 of the shape's
/// size is taken; else the face that the point is on, or the material point itself.
SurfaceElement element_at(const BodyShape& shape, const Vec3& point, const Vec3& outward);

/// The corner or edge within 1e-6 of the shape's size of the point, the ball of a capsule about it,
/// the ellipsoid, or the material point; never a plane. For what lies on a face.
SurfaceElement border_at(const BodyShape& shape, const Vec3& point, const Vec3& outward);

/// Whether an element is a piece of the shape itself, not a material point somewhere on it.
bool is_feature(const BodyShape& shape, const SurfaceElement& element);

/// A material point of the surface.
SurfaceElement material_point(const Vec3& point);

}  // namespace tumble
