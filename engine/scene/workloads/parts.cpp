#include "engine/scene/workloads/parts.hpp"

namespace tumble {
namespace {

BodyDef body_of(const Vec3& x, ShapeDef shape) {
  BodyDef def;
  def.pose.x = x;
  def.shapes.push_back({std::move(shape), {}, {}});
  return def;
}

}  // namespace

ShapeDef box_shape(const Vec3& half_extents) {
  ShapeDef shape;
  shape.type = ShapeType::box;
  shape.half_extents = half_extents;
  return shape;
}

BodyDef box_body(const Vec3& x, const Vec3& half_extents) {
  return body_of(x, box_shape(half_extents));
}

BodyDef sphere_body(const Vec3& x, double radius) {
  ShapeDef shape;
  shape.type = ShapeType::sphere;
  shape.radius = radius;
  return body_of(x, shape);
}

BodyDef capsule_body(const Vec3& x, double radius, double half_length) {
  ShapeDef shape;
  shape.type = ShapeType::capsule;
  shape.radius = radius;
  shape.height = 2 * half_length;
  return body_of(x, shape);
}

BodyDef fixed_box(const Vec3& x, const Vec3& half_extents) {
  BodyDef def = box_body(x, half_extents);
  def.type = BodyType::fixed;
  return def;
}

BodyDef wide_floor() {
  return fixed_box({0, -1, 0}, {100, 1, 100});
}

void add_bin(Workload& w, double half_width, double wall_height) {
  const double t = 0.5, h = 0.5 * wall_height, at = half_width + t, outer = half_width + 2 * t;
  w.bodies.push_back(fixed_box({0, -t, 0}, {outer, t, outer}));
  for (const double side : {1.0, -1.0})
    w.bodies.push_back(fixed_box({side * at, h, 0}, {t, h, outer}));
  for (const double side : {1.0, -1.0})
    w.bodies.push_back(fixed_box({0, h, side * at}, {half_width, h, t}));
}

Vec3 layered_place(int i, int side, double pitch, double bottom) {
  const int layer = i / (side * side), in_layer = i % (side * side);
  const double middle = (side - 1) / 2.0;
  return {(in_layer % side - middle) * pitch, bottom + pitch * layer,
          (in_layer / side - middle) * pitch};
}

}  // namespace tumble
