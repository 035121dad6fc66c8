#include "engine/scene/build/joint_defs.hpp"

#include "engine/math/rotation.hpp"
#include "engine/scene/repetition.hpp"
#include "engine/world/world.hpp"

#include <numbers>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The frame with z along the axis, and x along the component of the second axis perpendicular to
/// it.
Quat frame_of(const Vec3& axis, const std::optional<Vec3>& second) {
  Mat3 R;
  R.col(2) = axis.normalized();
  Vec3 x, y;
  tangent_frame(R.col(2), x, y);
  if (second) {
    x = (*second - R.col(2).dot(*second) * R.col(2)).normalized();
    y = R.col(2).cross(x);
  }
  R.col(0) = x;
  R.col(1) = y;
  return Quat(R).normalized();
}

Result<BodyId> body_named(const std::string& name, int i, const BuiltScene& built) {
  const auto counted = counted_name(name, i);
  if (!counted) return counted.error();
  const auto it = built.bodies.find(*counted);
  if (it != built.bodies.end()) return it->second;
  return Error{ErrorCode::not_found, "there is no body '" + *counted + "'", {}, {}};
}

constexpr double degree = std::numbers::pi / 180;

/// The one given, of a length and an angle in degrees.
std::optional<double> given(const std::optional<double>& length,
                            const std::optional<double>& degrees) {
  if (degrees) return degree * *degrees;
  return length;
}

CoordinateDrive drive_of(const DriveDescription& d) {
  CoordinateDrive out;
  if (d.limits) {
    out.limits.lower = given(d.limits->lower, d.limits->lower_deg).value_or(-no_bound);
    out.limits.upper = given(d.limits->upper, d.limits->upper_deg).value_or(no_bound);
    out.limits.stiffness = d.limits->stiffness;
    out.limits.damping = d.limits->damping;
    out.limits.restitution = d.limits->restitution;
  }
  if (d.motor) {
    const MotorDescription& m = *d.motor;
    out.motor.kind = m.velocity                     ? MotorKind::velocity
                     : m.position || m.position_deg ? MotorKind::position
                                                    : MotorKind::force;
    for (const auto* target : {&m.velocity, &m.position, &m.position_deg, &m.force}) {
      if (!*target) continue;
      const double unit = target == &m.position_deg ? degree : 1;
      out.motor.target = unit * (*target)->value;
      out.motor.course = course_of(**target, unit);
    }
    out.motor.stiffness = d.motor->stiffness.value_or(0);
    out.motor.damping = d.motor->damping.value_or(0);
    out.motor.max_force = d.motor->max_force.value_or(no_bound);
  }
  if (d.spring) {
    out.spring.stiffness = d.spring->stiffness;
    out.spring.damping = d.spring->damping;
    out.spring.rest = given(d.spring->rest, d.spring->rest_deg).value_or(0);
  }
  out.friction = d.friction;
  out.armature = d.armature;
  return out;
}

/// Calls f(coordinate, description) for all coordinates of a joint that have a description.
template <class F>
void for_coordinates(const JointDescription& d, const F& f) {
  if (!d.drive.empty()) f(size_t{0}, d.drive);
  JointDescription::for_drives(d, [&](std::string_view name, const auto& drive) {
    if (drive) f(coordinate_named(d.kind, name), *drive);
  });
}

void set_drives(const JointDescription& d, JointDef& out) {
  for_coordinates(
      d, [&](size_t k, const DriveDescription& drive) { out.drives[k] = drive_of(drive); });
  out.break_force = d.break_force.value_or(no_bound);
  out.break_torque = d.break_torque.value_or(no_bound);
}

std::string copy_name(const std::string& name, const JointDescription& joint, int i) {
  return joint.count == 1 ? name : fmt::format("{}[{}]", name, i);
}

Result<JointDef> joint_def(const JointDescription& d, int i, const BuiltScene& built) {
  JointDef out;
  out.kind = d.kind;
  out.collide = d.collide;
  Pose on_a;
  if (!d.a.empty()) {
    const auto a = body_named(d.a, i, built);
    if (!a) return a.error();
    out.a = *a;
    on_a = built.world->body(*a)->body_frame();
  }
  const auto b = body_named(d.b, i, built);
  if (!b) return b.error();
  out.b = *b;
  const Pose on_b = built.world->body(*b)->body_frame();
  out.frame_a = {d.anchor, frame_of(d.axis, d.axis_b)};
  const Pose world = on_a * out.frame_a;
  Pose at_start = world;
  if (d.start) at_start.x += world.direction(Vec3(0, 0, *d.start));
  if (d.start_deg) at_start.q = world.q * axis_angle(Vec3::UnitZ(), degree * *d.start_deg);
  out.frame_b = on_b.inverse() * at_start;
  if (d.axis_on_b) {
    // Rotated to there on the shortest way from its orientation at the start.
    const Vec3 from = out.frame_b.direction(Vec3::UnitZ());
    out.frame_b.q = rotation_between(from, d.axis_on_b->normalized()) * out.frame_b.q;
  }
  if (d.anchor_b) out.frame_b.x = *d.anchor_b;
  set_drives(d, out);
  if (d.kind == JointKind::distance || d.kind == JointKind::free) {
    out.frame_b.x = d.anchor_b.value_or(Vec3::Zero());
    out.length = d.length.value_or((on_b.point(out.frame_b.x) - world.x).norm());
  }
  return out;
}

Error coupling_error(std::string message) {
  return {ErrorCode::not_found, std::move(message), {}, {}};
}

/// The coupling of a coordinate of copy `i` of a joint.
Result<CoordinateCouple> couple_of(const CoupleDescription& d, int i, JointId own,
                                   JointKind own_kind, size_t own_coordinate,
                                   const BuiltScene& built) {
  CoordinateCouple out{{}, 0, d.ratio, given(d.offset, d.offset_deg).value_or(0)};
  JointKind kind = own_kind;
  if (!d.joint.empty()) {
    const auto counted = counted_name(d.joint, i);
    if (!counted) return counted.error();
    const auto it = built.joints.find(*counted);
    if (it == built.joints.end()) return coupling_error("there is no joint '" + *counted + "'");
    out.joint = it->second;
    kind = built.world->joint(it->second)->kind;
  }
  const std::vector<JointCoordinate>& all = entry_of(kind).coordinates;
  const size_t at = d.coordinate.empty() ? 0 : coordinate_named(kind, d.coordinate);
  if (at >= all.size() || (d.coordinate.empty() && all.size() > 1))
    return coupling_error(names_of_coordinates(entry_of(kind)));
  if ((d.joint.empty() || out.joint == own) && at == own_coordinate)
    return coupling_error("a coordinate cannot be coupled to itself: name another joint");
  out.coordinate = uint32_t(at);
  return out;
}

}  // namespace

Result<std::vector<std::pair<JointId, JointDef>>> couple_joints(const std::string& name,
                                                                const JointDescription& joint,
                                                                const BuiltScene& built) {
  std::vector<std::pair<JointId, JointDef>> out;
  bool any = false;
  for_coordinates(joint, [&](size_t, const DriveDescription& d) { any = any || d.couple; });
  if (!any) return out;
  std::optional<Error> error;
  for (int i = 0; i < joint.count && !error; ++i) {
    const auto it = built.joints.find(copy_name(name, joint, i));
    if (it == built.joints.end()) continue;  // a fault was reported for it
    JointDef def = *built.world->joint(it->second);
    for_coordinates(joint, [&](size_t k, const DriveDescription& d) {
      if (!d.couple || error) return;
      const auto couple = couple_of(*d.couple, i, it->second, joint.kind, k, built);
      if (couple)
        def.drives[k].couple = *couple;
      else
        error = couple.error();
    });
    out.emplace_back(it->second, std::move(def));
  }
  if (error) return *error;
  return out;
}

Result<std::vector<JointDef>> joint_defs(const std::string& name, const JointDescription& joint,
                                         const BuiltScene& built) {
  std::vector<JointDef> out;
  for (int i = 0; i < joint.count; ++i) {
    auto def = joint_def(joint, i, built);
    if (!def) return def.error();
    def->name = copy_name(name, joint, i);
    out.push_back(std::move(*def));
  }
  return out;
}

}  // namespace tumble
