#include "engine/dynamics/joints/joint.hpp"

#include "engine/dynamics/joints/tolerances.hpp"

#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

bool usable(const Pose& p) {
  return p.x.allFinite() && p.q.coeffs().allFinite() && p.q.norm() > tolerances::no_rotation_length;
}

Error bad_joint(std::string message) {
  return {ErrorCode::invalid_argument, std::move(message), "joint", {}};
}

/// From the frame of the definition to that of the centre of mass.
Pose about_centre(const Pose& frame, const RigidBody* body) {
  return {body ? Vec3(frame.x - body->centre_body) : frame.x, frame.q.normalized()};
}

const RigidBody* at_slot(std::span<const RigidBody> bodies, uint32_t slot) {
  return slot == no_body ? nullptr : &bodies[slot];
}

}  // namespace

Status validate(const JointDef& def) {
  if (size_t(def.kind) >= all_joint_kinds().size()) return bad_joint("there is no such kind");
  if (def.b.is_null()) return bad_joint("b must be a body; the world can only be a");
  if (def.a == def.b) return bad_joint("a and b are the same body");
  if (!usable(def.frame_a) || !usable(def.frame_b))
    return bad_joint("anchors and axes must be finite");
  if (def.kind == JointKind::distance && !(def.length > 0 && std::isfinite(def.length)))
    return bad_joint(fmt::format("length must be > 0, got {} m", def.length));
  return {};
}

Joint make_joint(const JointDef& def, const BodySet& bodies) {
  Joint j;
  j.kind = def.kind;
  j.a = def.a.is_null() ? no_body : def.a.index;
  j.b = def.b.index;
  j.frame_a = about_centre(def.frame_a, bodies.find(def.a));
  j.frame_b = about_centre(def.frame_b, bodies.find(def.b));
  j.length = def.length;
  j.collide = def.collide;
  return j;
}

namespace {

/// A side without axes.
JointSide joint_end(const Pose& frame, const RigidBody* body) {
  JointSide s;
  if (!body) {
    s.arm = frame.x;
    s.q = frame.q;
  } else {
    s.x = body->pose.x;
    s.v = body->v;
    s.omega = body->omega;
    s.arm = body->pose.direction(frame.x);
    s.q = body->pose.q * frame.q;
  }
  return s;
}

}  // namespace

JointSide joint_side(const Pose& frame, const RigidBody* body) {
  JointSide s = joint_end(frame, body);
  s.axes = s.q.toRotationMatrix();
  return s;
}

JointSides joint_sides(const Joint& joint, std::span<const RigidBody> bodies) {
  JointSides s{joint_end(joint.frame_a, at_slot(bodies, joint.a)),
               joint_end(joint.frame_b, at_slot(bodies, joint.b)), joint.length};
  if (entry_of(joint.kind).uses_axes) {
    s.a.axes = s.a.q.toRotationMatrix();
    s.b.axes = s.b.q.toRotationMatrix();
  }
  s.a.block = joint.a;
  s.b.block = joint.b;
  return s;
}

void joint_rows(JointKind kind, const JointSides& sides, JointRows& out) {
  for (const JointPart part : entry_of(kind).parts) part(sides, out);
}

size_t row_count(JointKind kind) {
  JointRows rows;
  joint_rows(kind, {}, rows);
  return rows.size();
}

}  // namespace tumble
