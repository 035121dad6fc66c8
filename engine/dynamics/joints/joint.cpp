#include "engine/dynamics/joints/joint.hpp"

#include "engine/dynamics/joints/tolerances.hpp"

#include <algorithm>
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

/// From the definition's body frame to the frame of the centre of mass.
Pose about_centre(const Pose& frame, const RigidBody* body) {
  return {body ? Vec3(frame.x - body->centre_body) : frame.x, frame.q.normalized()};
}

Status validate_drives(const JointDef& def) {
  const JointKindEntry& kind = entry_of(def.kind);
  for (size_t k = 0; k < most_coordinates; ++k) {
    if (k >= kind.coordinates.size()) {
      if (!def.drives[k].acts() && !def.drives[k].couple) continue;
      return bad_joint(fmt::format("something acts along coordinate {}, but a {} joint has only {}",
                                   k, kind.name, kind.coordinates.size()));
    }
    if (std::string fault = fault_of(def.drives[k]); !fault.empty())
      return bad_joint(fmt::format("{}: {}", kind.coordinates[k].name, fault));
    const std::optional<CoordinateCouple>& couple = def.drives[k].couple;
    if (!couple || !couple->joint.is_null()) continue;
    if (couple->coordinate == k)
      return bad_joint(
          fmt::format("{}: a coordinate cannot be coupled to itself", kind.coordinates[k].name));
    if (couple->coordinate >= kind.coordinates.size())
      return bad_joint(fmt::format("{}: it is coupled to coordinate {}, but a {} joint has only {}",
                                   kind.coordinates[k].name, couple->coordinate, kind.name,
                                   kind.coordinates.size()));
  }
  return {};
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
  if (!(def.break_force > 0) || !(def.break_torque > 0))
    return bad_joint(fmt::format("break_force and break_torque must be > 0, got {} N and {} N m",
                                 def.break_force, def.break_torque));
  return validate_drives(def);
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
  const auto acts = [](const CoordinateDrive& d) { return d.acts(); };
  if (std::ranges::any_of(def.drives, acts)) j.drives = std::make_shared<JointDrives>(def.drives);
  follow_coordinates(j, bodies.bodies, 0);
  return j;
}

namespace {

/// Sets everything of a side except its axes and block.
void put_end(const Pose& frame, const RigidBody* body, JointSide& s) {
  if (!body) {
    s.x.setZero(), s.v.setZero(), s.omega.setZero();
    s.arm = frame.x;
    s.q = frame.q;
  } else {
    s.x = body->pose.x;
    s.v = body->v;
    s.omega = body->omega;
    s.arm = body->pose.direction(frame.x);
    s.q = body->pose.q * frame.q;
  }
}

}  // namespace

JointSide joint_side(const Pose& frame, const RigidBody* body) {
  JointSide s;
  put_end(frame, body, s);
  s.axes = s.q.toRotationMatrix();
  return s;
}

void put_joint_sides(const Joint& joint, std::span<const RigidBody> bodies, JointSides& s) {
  put_end(joint.frame_a, at_slot(bodies, joint.a), s.a);
  put_end(joint.frame_b, at_slot(bodies, joint.b), s.b);
  s.length = joint.length;
  if (joint.drives || joint.coupled || entry_of(joint.kind).uses_axes) {
    s.a.axes = s.a.q.toRotationMatrix();
    s.b.axes = s.b.q.toRotationMatrix();
  }
}

JointSides joint_sides(const Joint& joint, std::span<const RigidBody> bodies) {
  JointSides s;
  put_joint_sides(joint, bodies, s);
  s.a.block = joint.a;
  s.b.block = joint.b;
  return s;
}

JointSides sides_with_axes(const Joint& joint, std::span<const RigidBody> bodies) {
  return {joint_side(joint.frame_a, at_slot(bodies, joint.a)),
          joint_side(joint.frame_b, at_slot(bodies, joint.b)), joint.length};
}

double row_rate(const JointRow& row, const JointSides& s) {
  return row.row.a.linear.dot(s.a.v) + row.row.a.angular.dot(s.a.omega) +
         row.row.b.linear.dot(s.b.v) + row.row.b.angular.dot(s.b.omega);
}

void follow_coordinates(Joint& joint, std::span<const RigidBody> bodies, double h, bool solved) {
  const std::vector<JointCoordinate>& coordinates = entry_of(joint.kind).coordinates;
  if (coordinates.empty()) return;
  const JointSides sides = sides_with_axes(joint, bodies);
  for (size_t k = 0; k < coordinates.size(); ++k) {
    const JointRow row = coordinates[k].row(sides);
    const double rate = row_rate(row, sides);
    const double passed = solved && (joint.driven(k) || joint.is_coupled(k)) ? 0 : h;
    const double expected = joint.value[k] + 0.5 * passed * (joint.rate[k] + rate);
    joint.value[k] = coordinates[k].turns ? nearest_turn(row.error, expected) : row.error;
    joint.rate[k] = rate;
  }
}

JointEnergies energy_of_joints(std::span<const Joint> joints, std::span<const RigidBody> bodies) {
  JointEnergies out;
  for (const Joint& joint : joints) {
    if (!joint.drives) continue;
    Joint now = joint;
    follow_coordinates(now, bodies, 0);
    for (size_t k = 0; k < most_coordinates; ++k) {
      const CoordinateDrive& drive = (*joint.drives)[k];
      out.potential += potential_energy(drive, now.value[k]);
      out.kinetic += 0.5 * drive.armature * now.rate[k] * now.rate[k];
    }
  }
  return out;
}

JointRow* joint_rows(JointKind kind, const JointSides& sides, JointRow* out) {
  for (const JointPart part : entry_of(kind).parts) out = part(sides, out);
  return out;
}

size_t row_count(JointKind kind) {
  static const std::vector<size_t> counts = [] {
    std::vector<size_t> out;
    for (const JointKindEntry& entry : all_joint_kinds()) {
      JointRows rows;
      joint_rows(entry.kind, {}, rows);
      out.push_back(rows.size());
    }
    return out;
  }();
  return counts[size_t(kind)];
}

}  // namespace tumble
