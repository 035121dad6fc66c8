#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {

Softness soft_step(double frequency, double damping_ratio, double h) {
  const double w = 2 * std::numbers::pi * frequency;
  const double a1 = 2 * damping_ratio + h * w;
  const double a2 = h * w * a1;
  return {w / a1, a2 / (1 + a2), 1 / (1 + a2)};
}

ContactSoftness contact_softness(const RealtimeSettings& settings, double hs) {
  const double frequency =
      std::min(settings.contact_frequency, tolerances::contact_frequency_share / hs);
  const double zeta = settings.contact_damping_ratio;
  return {soft_step(frequency, zeta, hs),
          soft_step(tolerances::hard_contact_frequency * frequency, zeta, hs)};
}

namespace {

/// Softness of contacts in islands with springs: none, however hard the springs press.
Softness rigid_step(double hs) {
  return {tolerances::rigid_share / hs, 1, 0};
}

/// Mobility u.K v of a body's point: K P is its change of velocity by an impulse P at lever arm r.
double mobility(const SolverBody& body, const Vec3& r, const Vec3& u, const Vec3& v) {
  return body.inverse_mass * u.dot(v) + r.cross(u).dot(body.inverse_inertia * r.cross(v));
}

void set_masses(const SolverIsland& island, const ContactRow& row, PointRow& p) {
  const SolverBody& a = island.bodies[row.a];
  const SolverBody& b = island.bodies[row.b];
  const auto k = [&](const Vec3& u, const Vec3& v) {
    return mobility(a, p.ra, u, v) + mobility(b, p.rb, u, v);
  };
  p.normal_mass = 1 / k(row.n, row.n);
  const double k11 = k(row.t1, row.t1), k12 = k(row.t1, row.t2), k22 = k(row.t2, row.t2);
  const double det = k11 * k22 - k12 * k12;
  p.m11 = k22 / det;
  p.m12 = -k12 / det;
  p.m22 = k11 / det;
  const double half = 0.5 * (k11 + k22), diff = 0.5 * (k11 - k22);
  p.tangent_mass = 1 / (half + std::sqrt(diff * diff + k12 * k12));
}

/// Sets the masses of rolling and torsional friction; the axes of the row must be set.
void set_turning_masses(const SolverIsland& island, ContactRow& row) {
  const Mat3 axes = Mat3::from_columns(row.t1, row.t2, row.n);
  const Mat3 k = island.bodies[row.a].inverse_inertia + island.bodies[row.b].inverse_inertia;
  row.turning.set_masses(axes.transpose() * k * axes);
}

void prepare_turning(const SolverIsland& island, const Contact& contact, double hs,
                     ContactRow& row) {
  row.resists_turning = contact.resists_turning();
  if (!row.resists_turning) return;
  const Vec3& torque = contact.turning_torque;
  row.turning.rolling = contact.rolling_friction;
  row.turning.torsional = contact.torsional_friction;
  row.turning.impulse = hs * Vec3(row.t1.dot(torque), row.t2.dot(torque), row.n.dot(torque));
  row.turning.sum.setZero();
  set_turning_masses(island, row);
}

Vec3 point_velocity(const SolverBody& body, const Vec3& r) {
  return body.v + body.w.cross(r);
}

/// Speed after a bounce that returns e^2 of the energy of the approach. The contact closes some
/// time within the tick and is left at its end, so the fall through the gap is added to the speed
/// at the start.
double bounce_speed(double e, double approach, double acceleration, double gap) {
  return e * std::sqrt(approach * approach + 2 * std::max(0.0, acceleration) * std::max(0.0, gap));
}

void prepare_point(const SolverContext& c, const SolverIsland& island, const ContactRow& row,
                   const ContactPoint& from, double restitution, double hs, PointRow& p) {
  const SolverBody& a = island.bodies[row.a];
  const SolverBody& b = island.bodies[row.b];
  p.gap = from.gap;
  set_masses(island, row, p);
  p.normal = hs * from.normal_force;
  p.tangent1 = hs * row.t1.dot(from.friction_force);
  p.tangent2 = hs * row.t2.dot(from.friction_force);
  p.normal_sum = p.tangent1_sum = p.tangent2_sum = 0;
  p.bounce = p.rebound = 0;
  if (!(restitution > 0)) return;
  const double approach = -row.n.dot(point_velocity(b, p.rb) - point_velocity(a, p.ra));
  if (approach <= c.settings->restitution_threshold) return;
  const double acceleration =
      row.n.dot(island.motions[row.a].acceleration - island.motions[row.b].acceleration);
  p.bounce = bounce_speed(restitution, approach, acceleration, p.gap);
}

void prepare_body(const SolverContext& c, double hs, double kick, SolverBody& out,
                  SolverMotion& motion) {
  motion.dq = Quat::Identity();
  out.dx.setZero();
  out.turn.setZero();
  if (motion.slot == ~uint32_t{0}) return;
  const RigidBody& body = c.bodies[motion.slot];
  const BodyVelocity first = first_velocity(c, motion.slot, hs, kick);
  out.v = first.v;
  out.w = first.omega;
  motion.dynamic = body.dynamic();
  motion.spins = turns_fast(body, c.h);
  if (!motion.dynamic) {
    const CourseMotion* const course = course_of(c.courses, motion.slot);
    motion.on_course = course != nullptr;
    if (course) motion.acceleration = course->change.v, motion.turning = course->change.omega;
    return;
  }
  // With the inertia tensor of an axis that is off by an angle d, an impact across a needle causes
  // d I3 / I1 times too much spin about its axis.
  motion.spins = motion.spins || slender_inertia(body.inertia_body);
  out.inverse_mass = body.inverse_mass;
  out.inverse_inertia = body.inverse_inertia_world();
  motion.acceleration = body.gravity_scale * c.gravity + body.inverse_mass * body.force;
  motion.spherical = isotropic_inertia(body.inertia_body);
}

}  // namespace

BodyVelocity first_velocity(const SolverContext& c, uint32_t slot, double hs, double kick) {
  const RigidBody& body = c.bodies[slot];
  const CourseMotion* const course = body.dynamic() ? nullptr : course_of(c.courses, slot);
  if (!course) return {body.v, body.omega};
  // The body's own velocity is the mean over all sub-steps, that of their middle.
  const double before_middle = 0.5 * c.h + kick - 0.5 * hs;
  return {body.v - before_middle * course->change.v,
          body.omega - before_middle * course->change.omega};
}

bool is_hard(const Contact& contact, bool both_move, bool delicate) {
  if (!both_move) return true;
  const bool round = contact.count == 1 && contact.rounding_a > 0 && contact.rounding_b > 0;
  return round && !delicate && contact.restitution == 0;
}

void prepare_rows(const SolverContext& c, const SolverIsland& island, double hs) {
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    prepare_body(c, hs, island.kick, island.bodies[i], island.motions[i]);
  }
  const auto [soft, hard] = contact_softness(*c.settings, hs);
  for (ContactRow& row : island.rows) {
    const Contact& contact = c.contacts[row.source];
    const SolverMotion& a = island.motions[row.a];
    const SolverMotion& b = island.motions[row.b];
    row.n = contact.normal;
    tangent_frame(row.n, row.t1, row.t2);
    row.friction = contact.friction;
    row.rounding_a = contact.rounding_a;
    row.rounding_b = contact.rounding_b;
    row.target1 = row.t1.dot(contact.surface_velocity);
    row.target2 = row.t2.dot(contact.surface_velocity);
    row.spins = a.spins || b.spins;
    const bool delicate = row.spins || a.jointed || b.jointed;
    row.soft = is_hard(contact, a.dynamic && b.dynamic, delicate) ? hard : soft;
    if (!island.springs.empty()) row.soft = rigid_step(hs);
    prepare_turning(island, contact, hs, row);
    const Pose& pose_a = c.bodies[contact.key.body_a].pose;
    const Pose& pose_b = c.bodies[contact.key.body_b].pose;
    for (uint32_t i = 0; i < row.count; ++i) {
      const ContactPoint& from = contact.points[i];
      PointRow& p = island.points[row.first + i];
      p.ra = pose_a.direction(from.anchor_a);
      p.rb = pose_b.direction(from.anchor_b);
      prepare_point(c, island, row, from, contact.restitution, hs, p);
    }
  }
}

void refresh_spinning_rows(const SolverContext& c, const SolverIsland& island) {
  for (ContactRow& row : island.rows) {
    if (!row.spins) continue;
    if (row.resists_turning) set_turning_masses(island, row);
    const Contact& contact = c.contacts[row.source];
    const Pose& pose_a = c.bodies[contact.key.body_a].pose;
    const Pose& pose_b = c.bodies[contact.key.body_b].pose;
    const SolverBody& a = island.bodies[row.a];
    const SolverBody& b = island.bodies[row.b];
    for (uint32_t i = 0; i < row.count; ++i) {
      const ContactPoint& from = contact.points[i];
      PointRow& p = island.points[row.first + i];
      // Only the part of the arm inside the rounding turns with the body.
      const Vec3 round_a = row.rounding_a * row.n, round_b = -row.rounding_b * row.n;
      const Vec3 ra = pose_a.direction(from.anchor_a) - round_a;
      const Vec3 rb = pose_b.direction(from.anchor_b) - round_b;
      p.ra = ra + a.turn * ra + round_a;
      p.rb = rb + b.turn * rb + round_b;
      // solve_rows adds n.(turn r) with the new lever arms; corrected so that the sum stays that of
      // the old ones.
      p.gap = from.gap + row.n.dot(b.turn * (rb + round_b - p.rb) - a.turn * (ra + round_a - p.ra));
      set_masses(island, row, p);
    }
  }
}

}  // namespace tumble
