#include "engine/dynamics/event/cause_effects.hpp"

#include "engine/dynamics/bodies/point_mass.hpp"

#include <algorithm>
#include <array>

namespace tumble {

void CauseEffect::write(std::span<double> y) const {
  y[0] = work;
  y[1] = lost;
  for (size_t k = 0; k < 3; ++k) {
    y[2 + k] = momentum[int(k)];
    y[5 + k] = angular_momentum[int(k)];
  }
}

CauseEffect CauseEffect::read(std::span<const double> y) {
  return {y[0], y[1], Vec3(y[2], y[3], y[4]), Vec3(y[5], y[6], y[7])};
}

void JointImpulses::add(const JointImpulses& more) {
  for (size_t k = 0; k < rows.size(); ++k) rows[k] += more.rows[k];
  for (size_t k = 0; k < motors.size(); ++k) motors[k] += more.motors[k];
  for (size_t k = 0; k < turned.size(); ++k) turned[k] += more.turned[k];
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
  // Particles do not turn: the force acts at their centres.
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

void add_torque(const RigidBody& a, const RigidBody& b, const Vec3& torque, ContactEffects& out) {
  const double moved = (b.dynamic() ? 1 : 0) - (a.dynamic() ? 1 : 0);
  const double lost = torque.dot(b.omega - a.omega);
  const double work =
      (b.dynamic() ? torque.dot(b.omega) : 0) - (a.dynamic() ? torque.dot(a.omega) : 0);
  out[size_t(ContactCause::friction)].add({lost, lost, Vec3::Zero(), moved * torque});
  out[size_t(ContactCause::kinematic)].add({work - lost, work - lost, Vec3::Zero(), Vec3::Zero()});
}

namespace {

/// Books one side of the push along a row.
void add_side_push(const RowSide& s, double push, ContactCause cause, bool lost,
                   const MovingBlocks& blocks, ContactEffects& out) {
  CauseEffect& booked = out[size_t(cause)];
  CauseEffect& kinematic = out[size_t(ContactCause::kinematic)];
  const RigidBody& b = *blocks.bodies[s.block];
  const Vec3 along = push * s.linear, turn = push * s.angular;
  const BodyVelocity& u = blocks.velocities[s.block];
  const double work = along.dot(u.v) + turn.dot(u.omega);
  booked.add({work, lost ? work : 0, Vec3::Zero(), Vec3::Zero()});
  if (b.dynamic())
    booked.add({0, 0, along, b.pose.x.cross(along) + turn});
  else
    kinematic.add({-work, -work, Vec3::Zero(), Vec3::Zero()});
}

}  // namespace

void add_row_push(const Row& row, double push, ContactCause cause, const MovingBlocks& blocks,
                  ContactEffects& out) {
  for (const RowSide* s : {&row.a, &row.b})
    if (s->block != no_block) add_side_push(*s, push, cause, true, blocks, out);
}

void add_joint_pushes(const Articulation& held, std::span<const double> pushes,
                      const MovingBlocks& blocks, ContactEffects& out) {
  // Of the rows of a joint's parts the sum is booked, side by side.
  std::array<RowSide, 2> sum;
  const auto book = [&] {
    for (RowSide& s : sum)
      if (s.block != no_block) add_side_push(s, 1, ContactCause::joints, true, blocks, out);
    sum = {};
  };
  uint32_t owner = 0;
  for (size_t i = 0; i < pushes.size(); ++i) {
    const HeldRow& row = held.held()[i];
    if (row.use != RowUse::part) {
      held.for_sides(i, [&](const RowSide& s) {
        add_side_push(s, pushes[i],
                      row.use == RowUse::motor ? ContactCause::motors : ContactCause::joints,
                      row.use != RowUse::armature, blocks, out);
      });
      continue;
    }
    if (row.owner != owner) book();
    owner = row.owner;
    const Row& of = held.rows()[i].row;
    for (size_t k = 0; k < 2; ++k) {
      const RowSide& s = k == 0 ? of.a : of.b;
      sum[k].block = s.block;
      sum[k].linear += pushes[i] * s.linear;
      sum[k].angular += pushes[i] * s.angular;
    }
  }
  book();
}

ContactCause cause_of(const DrivePart& p) {
  if (p.limit()) return ContactCause::normal;
  return p.kind == DrivePart::Kind::motor ? ContactCause::motors : ContactCause::friction;
}

void GroupBooks::add_impulses(const EventDrives& drives, std::span<const double> impulses) {
  for (size_t i = 0; i < impulses.size(); ++i) {
    const DrivePart& p = drives.parts()[i];
    const DrivenCoordinate& c = drives.coordinate_of(p);
    joints[c.place].rows[drives.row_of(p)] += impulses[i];
    if (p.kind == DrivePart::Kind::motor) joints[c.place].motors[c.coordinate] += impulses[i];
  }
}

void GroupBooks::add_impulses(const Articulation& held, std::span<const double> impulses) {
  for (size_t i = 0; i < impulses.size(); ++i) {
    const HeldRow& row = held.held()[i];
    if (row.use == RowUse::coupling) {
      couplings[row.owner] += impulses[i];
      continue;
    }
    joints[row.owner].rows[row.place] += impulses[i];
    if (row.use == RowUse::motor) joints[row.owner].motors[held.coordinate_of(i)] += impulses[i];
  }
}

}  // namespace tumble
