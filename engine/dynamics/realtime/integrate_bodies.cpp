#include "engine/dynamics/realtime/integrate_bodies.hpp"

#include "engine/dynamics/bodies/slender.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

namespace {

/// integrate_rotation by series of sine and cosine for small angles, as in nearly every sub-step;
/// error below 1e-16 for half angles below 0.05.
Quat turned(const Quat& q, const Vec3& omega, double h) {
  const double half2 = 0.25 * h * h * omega.squaredNorm();
  if (half2 > tolerances::series_half_turn2) return integrate_rotation(q, omega, h);
  const double sinc = 1 - half2 / 6 * (1 - half2 / 20 * (1 - half2 / 42 * (1 - half2 / 72)));
  const double cosine = 1 - half2 / 2 * (1 - half2 / 12 * (1 - half2 / 30 * (1 - half2 / 56)));
  const Vec3 axis = (0.5 * h * sinc) * omega;
  return (Quat(cosine, axis.x(), axis.y(), axis.z()) * q).normalized();
}

Vec3 angular_velocity(const RigidBody& body, const Quat& q, const Vec3& L) {
  return q * (body.inverse_inertia_body * (q.conjugate() * L));
}

Vec3 angular_momentum(const RigidBody& body, const Quat& q, const Vec3& omega) {
  return q * (body.inertia_body * (q.conjugate() * omega));
}

}  // namespace

void rotate_freely(const RigidBody& body, Quat& q, Vec3& omega, double h) {
  const Vec3 L = angular_momentum(body, q, omega);
  Vec3 mid = omega;
  for (int i = 0; i < tolerances::midpoint_iterations; ++i)
    mid = angular_velocity(body, turned(q, mid, 0.5 * h), L);
  q = turned(q, mid, h);
  omega = angular_velocity(body, q, L);
}

namespace {

/// Free rotation over h in steps of at most a twentieth of a radian. A body that would need more
/// than `most` steps rotates about its present angular velocity instead: that keeps its energy,
/// whereas long midpoint steps end in rotation about the axis of least inertia and create energy.
/// Needles have a rule of their own.
void spin(const RigidBody& body, Quat& q, Vec3& omega, double h, int most) {
  if (const auto slender = slender_inertia(body.inertia_body)) {
    const Vec3 L = angular_momentum(body, q, omega);
    rotate_slender(*slender, q, L, h, most);
    omega = angular_velocity(body, q, L);
    return;
  }
  const double steps = std::ceil(h * omega.norm() / tolerances::rotation_step);
  if (!(steps <= most)) {
    q = turned(q, omega, h);
    return;
  }
  const int n = std::max(1, int(steps));
  for (int i = 0; i < n; ++i) rotate_freely(body, q, omega, h / n);
}

}  // namespace

BodyVelocity gained_velocity(const SolverContext& c, const SolverIsland& island, uint32_t body,
                             double hs) {
  const SolverMotion& motion = island.motions[body];
  if (motion.on_course) return {hs * motion.acceleration, hs * motion.turning};
  if (!motion.dynamic) return {};
  return {hs * motion.acceleration,
          island.bodies[body].inverse_inertia * (hs * c.bodies[motion.slot].torque)};
}

void integrate_velocities(const SolverContext& c, const SolverIsland& island, double hs) {
  for (uint32_t i = 0; i < island.bodies.size(); ++i) {
    const SolverMotion& motion = island.motions[i];
    if (!motion.on_course && !motion.dynamic) continue;
    const BodyVelocity gained = gained_velocity(c, island, i, hs);
    island.bodies[i].v += gained.v;
    island.bodies[i].w += gained.omega;
  }
}

void integrate_positions(const SolverContext& c, const SolverIsland& island, double hs) {
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    SolverMotion& motion = island.motions[i];
    if (motion.slot == ~uint32_t{0}) continue;
    SolverBody& body = island.bodies[i];
    const RigidBody& source = c.bodies[motion.slot];
    body.dx += hs * body.v;
    // Below a small angle per sub-step the gyroscopic term is negligible, except for jointed
    // bodies.
    const double slow = motion.jointed ? 0 : tolerances::gyroscopic_turn2;
    if (motion.dynamic && !motion.spherical && body.w.squaredNorm() * hs * hs > slow) {
      Quat q = motion.dq * source.pose.q;
      spin(source, q, body.w, hs, tolerances::most_rotation_steps);
      motion.dq = (q * source.pose.q.conjugate()).normalized();
    } else {
      motion.dq = turned(motion.dq, body.w, hs);
    }
    body.turn = motion.dq.toRotationMatrix() - Mat3::Identity();
    if (motion.dynamic && (motion.spins || motion.jointed) && !motion.spherical) {
      const Mat3 R = (motion.dq * source.pose.q).toRotationMatrix();
      body.inverse_inertia = R * source.inverse_inertia_body * R.transpose();
    }
  }
}

void fly(RigidBody& body, const Vec3& gravity, double h) {
  const Vec3 a = body.gravity_scale * gravity + body.inverse_mass * body.force;
  body.pose.x += h * body.v + (0.5 * h * h) * a;
  body.v += h * a;
  if (!body.torque.isZero(0)) {
    const Vec3 L = angular_momentum(body, body.pose.q, body.omega) + h * body.torque;
    body.omega = angular_velocity(body, body.pose.q, L);
  }
  const double angle = h * body.omega.norm();
  if (angle == 0) return;
  if (isotropic_inertia(body.inertia_body)) {
    body.pose.q = turned(body.pose.q, body.omega, h);
    return;
  }
  spin(body, body.pose.q, body.omega, h, tolerances::most_rotation_steps_in_flight);
}

void carry(RigidBody& body, double h) {
  body.pose.x += h * body.v;
  body.pose.q = integrate_rotation(body.pose.q, body.omega, h);
}

void store_bodies(const SolverContext& c, const SolverIsland& island) {
  for (size_t i = 0; i < island.bodies.size(); ++i) {
    const SolverMotion& motion = island.motions[i];
    if (!motion.dynamic) continue;
    RigidBody& body = c.bodies[motion.slot];
    body.pose.x += island.bodies[i].dx;
    body.pose.q = (motion.dq * body.pose.q).normalized();
    body.v = island.bodies[i].v;
    body.omega = island.bodies[i].w;
  }
}

}  // namespace tumble
