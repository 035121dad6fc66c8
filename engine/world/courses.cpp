#include "engine/world/courses.hpp"

#include "engine/dynamics/forces/field.hpp"
#include "engine/dynamics/islands/waking.hpp"
#include "engine/math/rotation.hpp"
#include "engine/math/time_course.hpp"
#include "engine/world/tick_common.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

Error no_value(double t, std::string whose) {
  return {ErrorCode::numeric, fmt::format("its course has no finite value at t = {} s", t),
          std::move(whose), "keep expressions in t finite for as long as the scene runs"};
}

double value_at(const std::shared_ptr<const TimeCourse>& course, double t) {
  return course ? course->at(t) : 0;
}

/// The prescribed pose of the body's frame.
Pose pose_at(const BodyDef& def, double t) {
  const BodyCourse& course = *def.course;
  Pose out = def.pose;
  for (int k = 0; k < 3; ++k) out.x[k] += value_at(course.x[size_t(k)], t);
  out.q = axis_angle(course.axis, value_at(course.angle, t)) * def.pose.q.normalized();
  return out;
}

/// The drives of a joint as they are in the coming tick.
JointDrives drives_now(const WorldState& s, const JointDef& def) {
  JointDrives out = def.drives;
  const double t0 = s.time(), t1 = s.time_after(), h = s.settings.tick.tick();
  for (CoordinateDrive& d : out) {
    if (!d.motor.course) continue;
    d.motor.target = d.motor.course->at(t0);
    d.motor.target_rate = (d.motor.course->at(t1) - d.motor.target) / h;
  }
  return out;
}

bool usable(const JointDrives& drives) {
  return std::ranges::all_of(drives, [](const CoordinateDrive& d) {
    return std::isfinite(d.motor.target) && std::isfinite(d.motor.target_rate);
  });
}

/// Whether a motor's target moves, or differs from that of the tick before.
bool differs(const JointDrives& now, const JointDrives& before) {
  for (size_t k = 0; k < now.size(); ++k)
    if (now[k].motor.target_rate != 0 || now[k].motor.target != before[k].motor.target) return true;
  return false;
}

void rouse(WorldState& s, uint32_t slot) {
  if (slot == no_body) return;
  RigidBody& b = s.bodies.bodies[slot];
  if (!b.dynamic() || !b.asleep) return;
  wake(b);
  s.roster.touch(slot);
  s.frames.mark_changed(slot);
}

void set_targets(WorldState& s, uint32_t slot, const JointDrives& drives) {
  Joint& joint = s.joints.joints[slot];
  if (!joint.drives || differs(drives, *joint.drives)) {
    rouse(s, joint.a);
    rouse(s, joint.b);
  }
  joint.drives = s.workspace.kept_drives.hold(drives);
}

/// Prescribed pose of a body at the end of the tick, and its rotation vector over the tick.
struct Aim {
  Pose frame;
  Vec3 turn;  ///< [rad]
};

Aim aim_of(const WorldState& s, uint32_t slot) {
  const BodyDef& def = *s.body_defs[slot];
  const double from = value_at(def.course->angle, s.time());
  const double to = value_at(def.course->angle, s.time_after());
  // Corrects the rounding error of earlier rotations: the rotation vector of a small rotation is
  // twice the vector part of its quaternion.
  const Quat behind = pose_at(def, s.time()).q * s.bodies.bodies[slot].pose.q.conjugate();
  const Vec3 left = (behind.w() < 0 ? -2 : 2) * behind.vec();
  return {pose_at(def, s.time_after()), left + (to - from) * def.course->axis.normalized()};
}

/// Whether a force is usable as it is in the middle of the tick from now, and at its end.
Status check_force(const WorldState& s, uint32_t slot, ForceDef& scratch) {
  scratch = *s.forces[slot];
  for (const double t : {0.5 * (s.time() + s.time_after()), s.time_after()}) {
    go_to(scratch, t);
    Status fine = check_ranges(scratch);
    if (fine) continue;
    Error error = fine.error();
    error.message = fmt::format("at t = {} s its course leads out of range: {}", t, error.message);
    return error;
  }
  return {};
}

void rouse_anchored(WorldState& s, const Anchor& a) {
  if (a.kind == Anchor::Kind::body && s.bodies.find(a.body)) rouse(s, a.body.index);
  if (a.kind != Anchor::Kind::particle || !s.particle_ids.contains(a.particles)) return;
  ParticleSystem& p = s.particles[a.particles.index];
  const size_t i = p.grains ? p.find(a.particle) : p.size();
  if (i < p.size() && p.rest[i].asleep()) p.rest[i] = {};
}

/// Wakes the grains of the systems between which a pair force acts; an empty list means all.
void rouse_paired(WorldState& s, const std::vector<ParticleSystemId>& between) {
  if (between.empty())
    for (ParticleSystem& p : s.particles) p.wake_grains();
  for (const ParticleSystemId id : between)
    if (s.particle_ids.contains(id)) s.particles[id.index].wake_grains();
}

/// Wakes what a force acts on: without anchors, targets and pairs everything.
void rouse_pulled(WorldState& s, const ForceDef& def) {
  const FieldTargets everything;
  const FieldTargets* targets = field_targets(def);
  const std::vector<ParticleSystemId>* between = paired_systems(def);
  if (!targets && anchors(def).empty() && !between) targets = &everything;
  if (targets) {
    const ForceContext context = s.force_context();
    const RigidBody* first = s.bodies.bodies.data();
    for_targets(
        *targets, context, [&](RigidBody& b) { rouse(s, uint32_t(&b - first)); },
        [](ParticleSystem& p) { p.wake_grains(); });
  }
  if (between) rouse_paired(s, *between);
  for (const Anchor& a : anchors(def)) rouse_anchored(s, a);
}

double gained(WorldState& s, uint32_t slot) {
  ForceDef& def = *s.forces[slot];
  if (!has_potential(def)) return 0;
  go_to(def, s.time());
  const double before = potential_energy(def, s.force_context());
  go_to(def, s.time_after());
  return potential_energy(def, s.force_context()) - before;
}

/// Sum of mass times position over all that gravity acts on [kg m]: its energy is minus its
/// acceleration times this.
Vec3 weighed(const WorldState& s) {
  Vec3 sum = Vec3::Zero();
  for (const RigidBody& b : s.bodies.bodies)
    if (b.dynamic()) sum += b.gravity_scale * b.mass * b.pose.x;
  for (const ParticleSystem& p : s.particles)
    for (size_t i = 0; i < p.size(); ++i) sum += p.gravity_scale * p.mass[i] * p.x[i];
  return sum;
}

Status check_gravity(const WorldState& s) {
  for (const double t : {0.5 * (s.time() + s.time_after()), s.time_after()})
    if (!gravity_at(s, t).allFinite()) return no_value(t, "settings.gravity");
  return {};
}

void rouse_all(WorldState& s) {
  for (uint32_t slot = 0; slot < s.bodies.bodies.size(); ++slot) rouse(s, slot);
  for (ParticleSystem& p : s.particles) p.wake_grains();
}

bool finite(const Aim& a) {
  return a.frame.x.allFinite() && a.frame.q.coeffs().allFinite() && a.turn.allFinite();
}

/// Slope of a quantity from the differences of its means over consecutive ticks: their mean where
/// the quantity is smooth, zero at an extremum or a jump (van Leer 1977, J. Comput. Phys. 23, eq.
/// 66). A difference that is not finite is ignored.
double limited_slope(double before, double after) {
  if (!std::isfinite(before)) before = after;
  if (!std::isfinite(after)) after = before;
  if (!(before * after > 0)) return 0;
  const double least =
      std::min({2 * std::fabs(before), 2 * std::fabs(after), 0.5 * std::fabs(before + after)});
  return std::copysign(least, before);
}

/// Second difference; 0 where it is no more than the rounding of its terms, as for a straight
/// course.
double second_difference(double a, double b, double c) {
  const double out = c - 2 * b + a, size = std::fabs(a) + 2 * std::fabs(b) + std::fabs(c);
  return std::fabs(out) <= 8 * std::numeric_limits<double>::epsilon() * size ? 0 : out;
}

/// Acceleration of the velocities in the tick that begins at time t.
BodyVelocity slope_in_tick(const WorldState& s, uint32_t slot, double t) {
  const BodyDef& def = *s.body_defs[slot];
  const double h = s.settings.tick.tick();
  std::array<Vec3, 4> x;
  std::array<double, 4> angle;
  for (size_t k = 0; k < 4; ++k) {
    const double at = t + (double(k) - 1) * h;
    x[k] = pose_at(def, at).point(s.bodies.bodies[slot].centre_body);
    angle[k] = value_at(def.course->angle, at);
  }
  BodyVelocity out;
  const auto slope = [h](double a, double b, double c, double d) {
    return limited_slope(second_difference(a, b, c), second_difference(b, c, d)) / (h * h);
  };
  for (int i = 0; i < 3; ++i) out.v[i] = slope(x[0][i], x[1][i], x[2][i], x[3][i]);
  out.omega = slope(angle[0], angle[1], angle[2], angle[3]) * def.course->axis.normalized();
  return out;
}

/// Sets the velocities that bring the body to its aim.
void set_velocity(WorldState& s, uint32_t slot, const Aim& aim) {
  RigidBody& b = s.bodies.bodies[slot];
  const double h = s.settings.tick.tick();
  const bool moved = is_active(b);
  b.v = (aim.frame.point(b.centre_body) - b.pose.x) / h;
  b.omega = aim.turn / h;
  // A body that begins to move looks for contacts, and one that stops does not.
  if (moved != is_active(b)) s.forget_bodies();
}

}  // namespace

bool has_courses(const WorldState& s) {
  return !s.on_course.empty() || !s.joints.timed.empty() || !s.forces_on_course.empty() ||
         s.settings.gravity.varies();
}

Vec3 gravity_at(const WorldState& s, double t) {
  Vec3 out;
  for (int k = 0; k < 3; ++k) {
    const Varying& part = s.settings.gravity.of[size_t(k)];
    out[k] = part.course ? part.course->at(t) : part.value;
  }
  return out;
}

double greatest_gravity(const WorldState& s) {
  const double t0 = s.time(), t1 = s.time_after();
  return std::max(
      {gravity_at(s, t0).norm(), gravity_at(s, 0.5 * (t0 + t1)).norm(), gravity_at(s, t1).norm()});
}

CourseSupply::CourseSupply(WorldState& s) {
  for (const uint32_t slot : s.forces_on_course) before_.push_back(gained(s, slot));
  if (s.settings.gravity.varies()) weighed_before_ = weighed(s);
  return_to_now(s);
}

void CourseSupply::book(WorldState& s) const {
  for (size_t i = 0; i < before_.size(); ++i) {
    const uint32_t slot = s.forces_on_course[i];
    s.ledger.book_force(slot, {.balance = 0.5 * (before_[i] + gained(s, slot))});
    go_to(*s.forces[slot], s.time_after());
  }
  if (!s.settings.gravity.varies()) return;
  const Vec3 change = gravity_at(s, s.time_after()) - gravity_at(s, s.time());
  s.ledger.book(LedgerLine::gravity, {.balance = -0.5 * change.dot(weighed_before_ + weighed(s))});
  s.settings.gravity.go_to(s.time_after());
}

void set_motor_targets(WorldState& s) {
  for (const uint32_t slot : s.joints.timed) {
    const JointDrives drives = drives_now(s, s.joints.defs[slot]);
    if (usable(drives)) s.joints.joints[slot].drives = s.workspace.kept_drives.hold(drives);
  }
}

Status follow_courses(WorldState& s) {
  // All are looked at before any is changed, and worked out anew then, which needs no memory.
  for (const uint32_t slot : s.joints.timed) {
    const JointDef& def = s.joints.defs[slot];
    if (!usable(drives_now(s, def)))
      return no_value(s.time_after(), fmt::format("joint '{}'", def.name));
  }
  for (const uint32_t slot : s.on_course)
    if (!finite(aim_of(s, slot))) return no_value(s.time_after(), body_label(s, slot));
  ForceDef scratch;
  for (const uint32_t slot : s.forces_on_course)
    if (Status fine = check_force(s, slot, scratch); !fine) return fine;
  if (Status fine = check_gravity(s); !fine) return fine;
  for (const uint32_t slot : s.joints.timed)
    set_targets(s, slot, drives_now(s, s.joints.defs[slot]));
  for (const uint32_t slot : s.on_course) set_velocity(s, slot, aim_of(s, slot));
  for (const uint32_t slot : s.forces_on_course) {
    ForceDef& def = *s.forces[slot];
    if (differs_at(def, s.time_after())) rouse_pulled(s, def);
    go_to(def, 0.5 * (s.time() + s.time_after()));
  }
  const double middle = 0.5 * (s.time() + s.time_after());
  VaryingVec3& gravity = s.settings.gravity;
  if (gravity.differs_at(middle) || gravity.differs_at(s.time_after())) rouse_all(s);
  gravity.go_to(middle);
  return {};
}

std::span<const CourseMotion> course_motions(WorldState& s) {
  std::vector<CourseMotion>& out = s.workspace.courses;
  out.clear();
  const double half = 0.5 * s.settings.tick.tick();
  for (const uint32_t slot : s.on_course) {
    const RigidBody& b = s.bodies.bodies[slot];
    if (!is_active(b)) continue;
    const BodyVelocity change = slope_in_tick(s, slot, s.time());
    out.push_back({slot, {b.v - half * change.v, b.omega - half * change.omega}, change});
  }
  return out;
}

void end_tick_on_courses(WorldState& s, std::span<const CourseMotion> motions) {
  if (motions.empty()) return;
  for (const CourseMotion& motion : motions) {
    const BodyVelocity at_end = motion.at(s.settings.tick.tick());
    RigidBody& b = s.bodies.bodies[motion.slot];
    b.v = at_end.v;
    b.omega = at_end.omega;
  }
  // Of those that the solver has followed. Joints between other bodies are followed afterwards.
  const auto moved = [&s](uint32_t slot) {
    return slot != no_body && s.bodies.bodies[slot].dynamic();
  };
  for (const uint32_t slot : s.joints.watched) {
    Joint& joint = s.joints.joints[slot];
    const auto ties = [&joint](const auto& what) { return what(joint.a) || what(joint.b); };
    if (joint.followed() && ties(moved) &&
        ties([motions](uint32_t end) { return course_of(motions, end) != nullptr; }))
      follow_coordinates(joint, s.bodies.bodies, 0);
  }
}

std::vector<CourseMotion> course_changes(const WorldState& s) {
  std::vector<CourseMotion> out;
  const double h = s.settings.tick.tick();
  for (const uint32_t slot : s.on_course) {
    const RigidBody& b = s.bodies.bodies[slot];
    BodyVelocity change = slope_in_tick(s, slot, s.time());
    if (s.tick > 0) {
      const BodyVelocity before = slope_in_tick(s, slot, s.time() - h);
      change = {0.5 * (before.v + change.v), 0.5 * (before.omega + change.omega)};
    }
    out.push_back({slot, {b.v, b.omega}, change});
  }
  return out;
}

void begin_course(WorldState& s, uint32_t slot) {
  const BodyDef& def = *s.body_defs[slot];
  if (!def.course) return;
  const auto at = std::ranges::lower_bound(s.on_course, slot);
  if (at == s.on_course.end() || *at != slot) s.on_course.insert(at, slot);
  const Pose frame = pose_at(def, s.time());
  if (!frame.x.allFinite() || !frame.q.coeffs().allFinite()) return;  // the next tick reports it
  RigidBody& b = s.bodies.bodies[slot];
  b.pose = {frame.point(b.centre_body), frame.q};
}

void end_course(WorldState& s, uint32_t slot) {
  const auto at = std::ranges::lower_bound(s.on_course, slot);
  if (at == s.on_course.end() || *at != slot) return;
  s.on_course.erase(at);
  if (!s.body_defs[slot]) return;
  BodyDef def = *s.body_defs[slot];
  def.course = nullptr;
  s.body_defs[slot] = std::make_shared<const BodyDef>(std::move(def));
}

void begin_force(WorldState& s, uint32_t slot) {
  const auto at = std::ranges::lower_bound(s.forces_on_course, slot);
  const bool known = at != s.forces_on_course.end() && *at == slot;
  const bool follows = s.forces[slot] && follows_courses(*s.forces[slot]);
  if (known && !follows) s.forces_on_course.erase(at);
  if (follows && !known) s.forces_on_course.insert(at, slot);
  if (follows) go_to(*s.forces[slot], s.time());
}

void return_to_now(WorldState& s) {
  for (const uint32_t slot : s.forces_on_course) go_to(*s.forces[slot], s.time());
  s.settings.gravity.go_to(s.time());
}

void find_courses(WorldState& s) {
  s.forces_on_course.clear();
  for (uint32_t slot = 0; slot < s.forces.size(); ++slot)
    if (s.forces[slot] && follows_courses(*s.forces[slot])) s.forces_on_course.push_back(slot);
  s.on_course.clear();
  for (uint32_t slot = 0; slot < s.body_defs.size(); ++slot)
    if (s.body_defs[slot] && s.body_defs[slot]->course) s.on_course.push_back(slot);
}

}  // namespace tumble
