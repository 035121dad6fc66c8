#include "engine/scene/robot_files/robot_model.hpp"

#include "engine/math/rotation.hpp"

#include <cmath>
#include <numbers>

namespace tumble {
namespace {

ShapeDef robot_shape(ShapeType type) {
  ShapeDef out;
  out.type = type;
  return out;
}

}  // namespace

ShapeDef robot_sphere(double radius) {
  return ball_def(radius);
}

ShapeDef robot_box(const Vec3& half_extents) {
  ShapeDef out = robot_shape(ShapeType::box);
  out.half_extents = half_extents;
  return out;
}

ShapeDef robot_ellipsoid(const Vec3& semi_axes) {
  ShapeDef out = robot_shape(ShapeType::ellipsoid);
  out.half_extents = semi_axes;
  return out;
}

ShapeDef robot_capsule(double radius, double length) {
  ShapeDef out = robot_shape(ShapeType::capsule);
  out.radius = radius;
  out.height = length;
  return out;
}

ShapeDef robot_cylinder(double radius, double length) {
  ShapeDef out = robot_shape(ShapeType::cylinder);
  out.radius = radius;
  out.height = length;
  return out;
}

ShapeDef robot_plane() {
  return robot_shape(ShapeType::half_space);
}

ShapeDef robot_hull(std::shared_ptr<const TriangleMesh> points) {
  ShapeDef out = robot_shape(ShapeType::convex_hull);
  out.mesh = std::move(points);
  return out;
}

Quat z_from_y() {
  const double h = std::sqrt(0.5);
  return {h, h, 0, 0};
}

Pose displacement(const RobotJoint& joint) {
  const double moved = joint.start - joint.reference;
  if (joint.kind == RobotJoint::Kind::slide) return {moved * joint.axis, Quat::Identity()};
  if (joint.kind == RobotJoint::Kind::ball || moved == 0) return {};
  const Quat q = axis_angle(joint.axis, moved);
  return {joint.anchor - q * joint.anchor, q};
}

std::vector<Pose> start_poses(const RobotModel& model) {
  std::vector<Pose> out;
  for (const RobotLink& link : model.links) {
    Pose pose =
        link.parent == RobotLink::world ? link.in_parent : out[link.parent] * link.in_parent;
    for (const RobotJoint& joint : link.joints) pose = pose * displacement(joint);
    pose.q.normalize();
    out.push_back(pose);
  }
  return out;
}

}  // namespace tumble
