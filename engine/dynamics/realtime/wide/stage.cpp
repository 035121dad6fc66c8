// Moves data from bodies and contacts to the arrays of the kernels, and back.
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/realtime/solve_joints.hpp"
#include "engine/dynamics/realtime/wide/lane_values.hpp"
#include "engine/dynamics/realtime/wide/wide_island.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr uint32_t no_body_slot = ~uint32_t{0};
const ContactPoint no_point;
const Contact no_contact;

/// Rotation since the start of the tick.
Quat wide_turn(const WideBody& body) {
  const Vec3 u = doubles_of(body.turn);
  return {std::sqrt(std::max(0.0, 1 - u.squaredNorm())), u.x(), u.y(), u.z()};
}

void stage_motion(const RigidBody& from, const WideMass& mass, const Mat3& R, size_t lane,
                  WideMotion& out) {
  out.gyroscopic[lane] = mass.uneven;
  put_floats(out.inverse, lane, mass.inverse_inertia);
  if (mass.uneven > 0) put_floats(out.inertia, lane, packed(R * from.inertia_body * R.transpose()));
  const Vec3 alpha = from.torque.isZero(0)
                         ? Vec3(Vec3::Zero())
                         : Vec3(R * (from.inverse_inertia_body * (R.transpose() * from.torque)));
  put_floats(out.alpha, lane, alpha);
}

void stage_still(size_t lane, WideMotion& out) {
  out.gyroscopic[lane] = 0;
  put_floats(out.alpha, lane, Vec3::Zero());
}

void stage_contact(const Contact& from, WideContact& to, std::vector<WidePoint>& points,
                   size_t lane, bool delicate) {
  put_floats(to.n, lane, from.normal);
  to.friction[lane] = float(from.friction);
  to.restitution[lane] = float(from.restitution);
  to.hard[lane] = is_hard(from, (to.writes_a & to.writes_b) >> lane & 1, delicate) ? 1 : 0;
  to.rounding_a[lane] = float(from.rounding_a);
  to.rounding_b[lane] = float(from.rounding_b);
  to.rounds = to.rounds || from.rounding_a > 0 || from.rounding_b > 0;
  to.target1[lane] = float(from.surface_velocity.x());
  to.target2[lane] = float(from.surface_velocity.y());
  to.target3[lane] = float(from.surface_velocity.z());
  to.counts[lane] = uint32_t(from.count);
  for (uint32_t k = 0; k < to.count; ++k) {
    // Entries beyond the last point of a contact get zero masses and stay unchanged.
    const ContactPoint& p = k < to.counts[lane] ? from.points[k] : no_point;
    WidePoint& out = points[to.first + k];
    put_floats(out.ra, lane, p.anchor_a);
    put_floats(out.rb, lane, p.anchor_b);
    out.gap[lane] = float(p.gap);
    out.normal[lane] = float(p.normal_force);
    out.tangent1[lane] = float(p.friction_force.x());
    out.tangent2[lane] = float(p.friction_force.y());
    out.tangent1_sum[lane] = float(p.friction_force.z());
  }
}

/// Stages rolling and torsional friction, for a bundle with a WideTurning.
void stage_turning(const Contact& from, size_t lane, WideTurning& to) {
  to.rolling[lane] = float(from.rolling_friction);
  to.torsional[lane] = float(from.torsional_friction);
  put_floats(to.impulse, lane, from.turning_torque);
}

/// Fills in a lane without a contact, between the fixed body and itself.
void stage_nothing(WideContact& to, std::vector<WidePoint>& points, size_t lane, uint32_t fixed) {
  to.source[lane] = no_body_slot;
  to.a[lane] = to.b[lane] = fixed;
  stage_contact(no_contact, to, points, lane, false);
}

void store_turning(const WideTurning& from, uint32_t lane, double rate, const Vec3& t1,
                   const Vec3& t2, Contact& to) {
  // Contacts without such friction keep their zeros, whatever else is in the bundle.
  if (!to.resists_turning()) return;
  const Mat3 axes = Mat3::from_columns(t1, t2, to.normal);
  to.turning_torque = axes * (rate * doubles_of(from.impulse, lane));
  to.turning_impulse = axes * doubles_of(from.sum, lane);
}

}  // namespace

void WideIsland::stage_bodies(const SolverContext& c, double hs, uint32_t begin, uint32_t end) {
  for (uint32_t k = begin; k < end; ++k) {
    WideBody& to = rows_.bodies[k];
    WideMass& mass = rows_.masses[k];
    to = {};
    mass = {};
    if (slots_[k] == no_body_slot) {
      if (k < simple_) stage_still(k % wide_lanes, rows_.motions[k / wide_lanes]);
      continue;
    }
    const RigidBody& from = c.bodies[slots_[k]];
    const BodyVelocity first = first_velocity(c, slots_[k], hs, kick_);
    put_floats(to.v, first.v);
    put_floats(to.w, first.omega);
    for (int i = 0; i < 4; ++i) mass.q[size_t(i)] = float(from.pose.q.coeffs()[i]);
    if (!from.dynamic()) {
      if (const CourseMotion* const course = course_of(c.courses, slots_[k]))
        put_floats(to.acceleration, course->change.v);
      continue;
    }
    put_floats(to.acceleration, from.gravity_scale * c.gravity + from.inverse_mass * from.force);
    mass.inverse_mass = float(from.inverse_mass);
    mass.uneven = isotropic_inertia(from.inertia_body) ? 0 : 1;
    const Mat3 R = from.pose.q.toRotationMatrix();
    mass.inverse_inertia = packed(R * from.inverse_inertia_body * R.transpose());
    if (k < simple_) stage_motion(from, mass, R, k % wide_lanes, rows_.motions[k / wide_lanes]);
  }
}

void WideIsland::stage_bundle(const SolverContext& c, uint32_t i) {
  const Bundle& bundle = bundles_[i];
  WideContact& to = rows_.contacts[i];
  to.lanes = bundle.lanes;
  to.first = bundle.first_point;
  to.count = bundle.count;
  to.turning = bundle.turning;
  to.writes_a = to.writes_b = 0;
  to.rounds = false;
  for (size_t lane = 0; lane < wide_lanes; ++lane) {
    if (lane >= bundle.lanes) {
      stage_nothing(to, rows_.points, lane, fixed_);
      if (to.turning != WideContact::no_turning)
        stage_turning(no_contact, lane, rows_.turnings[to.turning]);
      continue;
    }
    const uint32_t edge = by_count_[bundle.first_edge + lane];
    const Contact& from = c.contacts[sources_[edge]];
    to.source[lane] = sources_[edge];
    if (edges_[edge].a != ColourEdge::fixed) to.writes_a = uint16_t(to.writes_a | 1u << lane);
    if (edges_[edge].b != ColourEdge::fixed) to.writes_b = uint16_t(to.writes_b | 1u << lane);
    // Each kinematic body has an index of its own, fixed ones share one.
    const auto at = [&](uint32_t slot) {
      return local_[slot] == no_body_slot ? fixed_ : local_[slot];
    };
    to.a[lane] = at(from.key.body_a);
    to.b[lane] = at(from.key.body_b);
    const auto delicate = [&](uint32_t slot) {
      return is(slot, BodyTraits::fast) || jointed_[slot];
    };
    stage_contact(from, to, rows_.points, lane,
                  delicate(from.key.body_a) || delicate(from.key.body_b));
    if (to.turning != WideContact::no_turning)
      stage_turning(from, lane, rows_.turnings[to.turning]);
  }
}

void WideIsland::stage_contacts(const SolverContext& c, WideRange bundles) {
  for (uint32_t i = bundles.begin; i < bundles.end; ++i) {
    if (i + 1 < bundles.end) fetch_contacts(c, i + 1);
    stage_bundle(c, i);
  }
}

/// Prefetches contacts, which for one colour are scattered in memory.
void WideIsland::fetch_contacts(const SolverContext& c, uint32_t i) const {
  const Bundle& bundle = bundles_[i];
  for (uint32_t lane = 0; lane < bundle.lanes; ++lane)
    prefetch<sizeof(ContactHead) + sizeof(ContactPoint)>(
        &c.contacts[sources_[by_count_[bundle.first_edge + lane]]]);
}

void WideIsland::stage_rest(const SolverContext& c, double hs) {
  bodies_.assign(rest_bodies_.size(), {});
  motions_.assign(rest_bodies_.size(), {});
  for (size_t k = 0; k < rest_bodies_.size(); ++k) {
    const uint32_t slot = slots_[rest_bodies_[k]];
    motions_[k].slot = slot;
    motions_[k].jointed = slot != no_body_slot && jointed_[slot];
  }
  prepare_rows(c, rest(), hs);
  prepare_joints(c, rest(), hs);
}

void WideIsland::store_contacts(const SolverContext& c, WideRange bundles, double hs) const {
  const double rate = 1 / hs;
  for (uint32_t i = bundles.begin; i < bundles.end; ++i) {
    const WideContact& from = rows_.contacts[i];
    if (i + 1 < bundles.end)
      for (uint32_t lane = 0; lane < rows_.contacts[i + 1].lanes; ++lane)
        prefetch_to_write<sizeof(ContactHead) + sizeof(ContactPoint)>(
            &c.contacts[rows_.contacts[i + 1].source[lane]]);
    for (uint32_t lane = 0; lane < from.lanes; ++lane) {
      Contact& to = c.contacts[from.source[lane]];
      const Vec3 t1 = doubles_of(from.t1, lane), t2 = to.normal.cross(t1);
      if (from.turning != WideContact::no_turning)
        store_turning(rows_.turnings[from.turning], lane, rate, t1, t2, to);
      for (uint32_t k = 0; k < from.counts[lane]; ++k) {
        const WidePoint& p = rows_.points[from.first + k];
        ContactPoint& out = to.points[k];
        out.normal_force = rate * double(p.normal[lane]);
        out.friction_force =
            (rate * double(p.tangent1[lane])) * t1 + (rate * double(p.tangent2[lane])) * t2;
        out.normal_impulse = double(p.normal_sum[lane]);
        out.friction_impulse =
            double(p.tangent1_sum[lane]) * t1 + double(p.tangent2_sum[lane]) * t2;
      }
    }
  }
}

void WideIsland::store_bodies(const SolverContext& c, uint32_t begin, uint32_t end) const {
  for (uint32_t k = begin; k < end; ++k) {
    if (slots_[k] == no_body_slot) continue;
    RigidBody& to = c.bodies[slots_[k]];
    if (!to.dynamic()) continue;
    const WideBody& from = rows_.bodies[k];
    to.pose.x += doubles_of(from.dx);
    to.pose.q = (wide_turn(from) * to.pose.q).normalized();
    // Adding +0 turns -0 into +0: the sign of a zero would depend on other lanes of its bundle.
    to.v = doubles_of(from.v) + Vec3::Zero();
    to.omega = doubles_of(from.w) + Vec3::Zero();
  }
}

void WideIsland::read_velocities() {
  for (size_t k = 0; k < rest_bodies_.size(); ++k) {
    bodies_[k].v = doubles_of(rows_.bodies[rest_bodies_[k]].v);
    bodies_[k].w = doubles_of(rows_.bodies[rest_bodies_[k]].w);
  }
}

void WideIsland::write_velocities() {
  for (size_t k = 0; k < rest_bodies_.size(); ++k) {
    put_floats(rows_.bodies[rest_bodies_[k]].v, bodies_[k].v);
    put_floats(rows_.bodies[rest_bodies_[k]].w, bodies_[k].w);
  }
}

void WideIsland::read_poses() {
  for (size_t k = special_; k < rest_bodies_.size(); ++k) {
    const WideBody& from = rows_.bodies[rest_bodies_[k]];
    bodies_[k].dx = doubles_of(from.dx);
    motions_[k].dq = wide_turn(from);
    bodies_[k].turn = motions_[k].dq.toRotationMatrix() - Mat3::Identity();
  }
}

void WideIsland::write_poses() {
  for (size_t k = 0; k < special_; ++k) {
    WideBody& to = rows_.bodies[rest_bodies_[k]];
    put_floats(to.dx, bodies_[k].dx);
    const Quat& q = motions_[k].dq;
    put_floats(to.turn, q.w() < 0 ? Vec3(-q.vec()) : Vec3(q.vec()));
  }
}

}  // namespace tumble
