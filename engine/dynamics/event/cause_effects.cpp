#include "engine/dynamics/event/cause_effects.hpp"

#include "engine/dynamics/bodies/point_mass.hpp"

#include <algorithm>

namespace tumble {

void CauseEffect::write(std::span<double> y) const {
  y[0] = work;
  y[1] = lost;
  for (size_t k = 0; k < 3; ++k) {
    y[2 + k] = momentum[Eigen::Index(k)];
    y[5 + k] = angular_momentum[Eigen::Index(k)];
  }
}

CauseEffect CauseEffect::read(std::span<const double> y) {
  return {y[0], y[1], Vec3(y[2], y[3], y[4]), Vec3(y[5], y[6], y[7])};
}

void GroupBooks::add_causes(const GroupBooks& part) {
  for (size_t i = 0; i < part.causes.size(); ++i) {
    const auto at = std::lower_bound(causes.begin(), causes.end(), part.causes[i]);
    const auto k = at - causes.begin();
    if (at == causes.end() || *at != part.causes[i]) {
      causes.insert(at, part.causes[i]);
      forces.insert(forces.begin() + k, CauseEffect{});
    }
    forces[size_t(k)].add(part.forces[i]);
  }
  for (size_t i = 0; i < contact_causes; ++i) contacts[i].add(part.contacts[i]);
}

void add_push(const RigidBody& a, const BodyVelocity& of_a, const RigidBody& b,
              const BodyVelocity& of_b, const Vec3& x, const Vec3& normal, const Vec3& push,
              const Vec3& belt, ContactEffects& out) {
  const Vec3 ua = of_a.v + of_a.omega.cross(x - a.pose.x);
  const Vec3 ub = of_b.v + of_b.omega.cross(x - b.pose.x);
  const double moved = (b.dynamic() ? 1 : 0) - (a.dynamic() ? 1 : 0);
  // Two particles that do not turn are both pushed where they are.
  const auto turned = [&](const RigidBody& body, const Vec3& part) -> Vec3 {
    if (!body.dynamic()) return Vec3::Zero();
    return (is_particle(body) ? body.pose.x : x).cross(part);
  };
  const auto book = [&](ContactCause line, const Vec3& part, const Vec3& slip) {
    CauseEffect& e = out[size_t(line)];
    const double lost = part.dot(slip);
    const double work = (b.dynamic() ? part.dot(ub) : 0) - (a.dynamic() ? part.dot(ua) : 0);
    e.add({lost, lost, moved * part, turned(b, part) - turned(a, part)});
    out[size_t(ContactCause::kinematic)].work += work - lost;
    out[size_t(ContactCause::kinematic)].lost += work - lost;
  };
  const Vec3 along = normal.dot(push) * normal;
  book(ContactCause::normal, along, ub - ua);
  book(ContactCause::friction, push - along, ub - ua - belt);
}

void add_joint_pushes(const Articulation& held, std::span<const double> pushes,
                      std::span<const RigidBody* const> bodies,
                      std::span<const BodyVelocity> velocities, ContactEffects& out) {
  CauseEffect& joints = out[size_t(ContactCause::joints)];
  CauseEffect& kinematic = out[size_t(ContactCause::kinematic)];
  for (size_t i = 0; i < pushes.size(); ++i) {
    held.for_sides(i, [&](const RowSide& s) {
      const RigidBody& b = *bodies[s.block];
      const Vec3 push = pushes[i] * s.linear, turn = pushes[i] * s.angular;
      const BodyVelocity& u = velocities[s.block];
      const double work = push.dot(u.v) + turn.dot(u.omega);
      joints.add({work, work, Vec3::Zero(), Vec3::Zero()});
      if (b.dynamic())
        joints.add({0, 0, push, b.pose.x.cross(push) + turn});
      else
        kinematic.add({-work, -work, Vec3::Zero(), Vec3::Zero()});
    });
  }
}

}  // namespace tumble
