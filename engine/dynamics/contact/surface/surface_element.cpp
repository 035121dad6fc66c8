#include "engine/dynamics/contact/surface/surface_element.hpp"

namespace tumble {
namespace {

SurfaceElement in_body(const BodyShape& shape, SurfaceElement e) {
  e.origin = shape.pose.point(e.origin);
  e.direction = shape.pose.direction(e.direction);
  if (e.kind == ElementKind::ellipsoid) e.semi_axes = shape.pose.q.toRotationMatrix() * e.semi_axes;
  return e;
}

}  // namespace

SurfaceElement element_at(const BodyShape& shape, const Vec3& point, const Vec3& outward) {
  return in_body(shape, shape.shape->element_at(shape.pose.inverse_point(point),
                                                shape.pose.inverse_direction(outward)));
}

SurfaceElement border_at(const BodyShape& shape, const Vec3& point, const Vec3& outward) {
  return in_body(shape, shape.shape->border_at(shape.pose.inverse_point(point),
                                               shape.pose.inverse_direction(outward)));
}

bool is_feature(const BodyShape& shape, const SurfaceElement& element) {
  if (element.kind != ElementKind::point) return true;
  SurfaceElement own = element;
  own.origin = shape.pose.inverse_point(element.origin);
  return shape.shape->has_point(own);
}

}  // namespace tumble
