#include "engine/world/ledger/realtime_books.hpp"

namespace tumble {
namespace {

/// The line of a force, or the user's for the mouse.
void book_share(Ledger& ledger, const std::optional<ForceDef>& def, uint32_t slot,
                const LedgerEntry& e) {
  if (def && std::holds_alternative<MouseSpringDef>(*def))
    ledger.book(LedgerLine::user, e);
  else
    ledger.book_force(slot, e);
}

Mat3 rotated_inertia(const RigidBody& b, const Quat& q) {
  const Mat3 R = q.toRotationMatrix();
  return R * b.inertia_body * R.transpose();
}

}  // namespace

void RealtimeBooks::begin_part(std::span<const RigidBody> bodies) {
  start_.clear();
  for (const RigidBody& b : bodies) start_.push_back({b.pose, b.v, b.omega});
  axes_.clear();
  for (const RigidBody& b : bodies) axes_.push_back(b.pose.q.toRotationMatrix());
}

void RealtimeBooks::find_means(std::span<const RigidBody> bodies, const ContactSet& contacts,
                               const IslandSet& islands, double h) {
  mean_.assign(bodies.size(), {});
  shifted_.assign(bodies.size(), Vec3::Zero());
  last_.clear();
  for (size_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& b = bodies[i];
    const Motion& from = start_[i];
    last_.push_back({b.pose, b.v, b.omega});
    mean_[i] = {0.5 * (from.pose.x + b.pose.x), 0.5 * (from.v + b.v), 0.5 * (from.omega + b.omega),
                b.dynamic() && islands.island_of[i] != 0};
    if (b.type == BodyType::fixed) mean_[i].v = mean_[i].omega = Vec3::Zero();
  }
  for (const Island& island : islands.islands) {
    if (island.contact_begin < island.contact_end || island.joint_begin < island.joint_end)
      continue;
    // What nothing touches turns freely after the kick of the torque, which is all that did work.
    for (uint32_t k = island.body_begin; k < island.body_end; ++k) {
      const uint32_t slot = islands.bodies[k];
      const RigidBody& b = bodies[slot];
      if (b.torque.isZero(0)) continue;
      const Mat3 R = start_[slot].pose.q.toRotationMatrix();
      const Vec3 torque_body = R.transpose() * b.torque;
      mean_[slot].omega =
          start_[slot].omega + 0.5 * h * (R * (b.inverse_inertia_body * torque_body));
    }
  }
  find_shifts(bodies, contacts, islands, h);
}

void RealtimeBooks::find_shifts(std::span<const RigidBody> bodies, const ContactSet& contacts,
                                const IslandSet& islands, double h) {
  const auto shift = [&](uint32_t slot, bool jointed) {
    if (!mean_[slot].moved) return;
    mean_[slot].jointed = jointed;
    shifted_[slot] = bodies[slot].pose.x - start_[slot].pose.x - h * mean_[slot].v;
  };
  for (const uint32_t k : islands.joints)
    for (const uint32_t slot : {joints.joints[k].a, joints.joints[k].b})
      if (slot != no_body) shift(slot, true);
  for (const uint32_t k : islands.contacts) {
    const Contact& c = contacts.contacts()[k];
    if (!c.pressed()) continue;
    shift(c.key.body_a, false);
    shift(c.key.body_b, false);
  }
}

void RealtimeBooks::book_joints(std::span<const RigidBody> bodies, const IslandSet& islands,
                                Ledger& ledger) const {
  LedgerEntry line, kinematic;
  for (const uint32_t k : islands.joints) {
    const Joint& joint = joints.joints[k];
    const auto& [P, moment_a, moment_b] = joints.pushes[k];
    const Mean& b = mean_[joint.b];
    LedgerEntry e = push(bodies, joint.b, P, moment_b);
    double work = P.dot(b.v) + moment_b.dot(b.omega);
    if (joint.a != no_body) {
      const Mean& a = mean_[joint.a];
      e.add(push(bodies, joint.a, -P, moment_a));
      work += moment_a.dot(a.omega) - P.dot(a.v);
    }
    // As of contacts: the rest is what bodies that nothing moves do by their own velocity.
    kinematic.work += e.work - work;
    e.work = e.balance = work;
    line.add(e);
  }
  kinematic.balance = kinematic.work;
  ledger.book(LedgerLine::joints, line);
  ledger.book(LedgerLine::kinematic, kinematic);
}

LedgerEntry RealtimeBooks::push(std::span<const RigidBody> bodies, uint32_t slot,
                                const Vec3& impulse, const Vec3& moment) const {
  if (!bodies[slot].dynamic()) return {};
  const Mean& m = mean_[slot];
  const double work = impulse.dot(m.v) + moment.dot(m.omega);
  return {work, work, impulse, m.x.cross(impulse) + moment};
}

void RealtimeBooks::book_push(const Contact& c, const Push& push_of, const Vec3& belt,
                              std::span<const RigidBody> bodies, LedgerEntry& line,
                              LedgerEntry& kinematic) const {
  const uint32_t a = c.key.body_a, b = c.key.body_b;
  const auto& [P, moment_a, moment_b] = push_of;
  LedgerEntry e = push(bodies, b, P, moment_b);
  e.add(push(bodies, a, -P, -moment_a));
  const double lost = P.dot(mean_[b].v - mean_[a].v - belt) + moment_b.dot(mean_[b].omega) -
                      moment_a.dot(mean_[a].omega);
  // Bodies that nothing moves do work by their own velocity, and belts by theirs.
  kinematic.work += e.work - lost;
  e.work = e.balance = lost;
  line.add(e);
}

void RealtimeBooks::book_contact(const Contact& c, std::span<const RigidBody> bodies,
                                 ContactLines& lines) const {
  if (!c.pressed() && c.spin_impulse == 0) return;
  const uint32_t a = c.key.body_a, b = c.key.body_b;
  Push normal, friction;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // weighted by the normal impulses
  double pressure = 0;
  for (int i = 0; i < c.count; ++i) {
    const ContactPoint& p = c.points[size_t(i)];
    const Vec3 ra = axes_[a] * p.anchor_a, rb = axes_[b] * p.anchor_b;
    pressure += p.normal_impulse;
    arm_a += p.normal_impulse * ra;
    arm_b += p.normal_impulse * rb;
    friction.impulse += p.friction_impulse;
    friction.moment_a += ra.cross(p.friction_impulse);
    friction.moment_b += rb.cross(p.friction_impulse);
  }
  normal = {pressure * c.normal, arm_a.cross(c.normal), arm_b.cross(c.normal)};
  book_push(c, normal, Vec3::Zero(), bodies, lines.normal, lines.kinematic);
  book_push(c, friction, c.surface_velocity, bodies, lines.friction, lines.kinematic);
  if (c.spin_impulse == 0) return;
  const Vec3 spin = c.spin_impulse * c.normal;
  book_push(c, {Vec3::Zero(), spin, spin}, Vec3::Zero(), bodies, lines.friction, lines.kinematic);
}

void RealtimeBooks::book_contacts(std::span<const RigidBody> bodies, const ContactSet& contacts,
                                  const IslandSet& islands, Ledger& ledger) const {
  ContactLines lines;
  for (const uint32_t k : islands.contacts) book_contact(contacts.contacts()[k], bodies, lines);
  lines.kinematic.balance = lines.kinematic.work;
  ledger.book(LedgerLine::restitution, lines.normal);
  ledger.book(LedgerLine::friction, lines.friction);
  ledger.book(LedgerLine::kinematic, lines.kinematic);
}

void RealtimeBooks::end_part(std::span<const RigidBody> bodies, const ContactSet& contacts,
                             const IslandSet& islands,
                             const std::vector<std::optional<ForceDef>>& forces,
                             const Vec3& gravity, double h, Ledger& ledger) {
  find_means(bodies, contacts, islands, h);
  LedgerEntry weight, projection, drawn;
  held_.assign(bodies.size(), Vec3::Zero());
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    if (!mean_[i].moved) continue;
    const Vec3 force = bodies[i].mass * bodies[i].gravity_scale * gravity;
    LedgerEntry e = push(bodies, i, h * force, Vec3::Zero());
    e.balance = 0;
    weight.add(e);
    held_[i] = force;
    LedgerEntry& shift = mean_[i].jointed ? drawn : projection;
    shift.angular_momentum += shifted_[i].cross(bodies[i].mass * mean_[i].v);
  }
  ledger.book(LedgerLine::gravity, weight);
  for (uint32_t slot = 0; slot < shares.size(); ++slot) {
    LedgerEntry sum;
    for (const ForceShare::OnBody& on : shares[slot].bodies) {
      if (!mean_[on.slot].moved) continue;
      LedgerEntry e = push(bodies, on.slot, h * on.force, Vec3::Zero());
      const double turning = h * on.torque.dot(mean_[on.slot].omega);
      e.work += turning;
      e.balance = (1 - shares[slot].conserved) * e.work;
      e.angular_momentum += h * on.torque;
      sum.add(e);
      held_[on.slot] += shares[slot].conserved * on.force;
    }
    if (!shares[slot].bodies.empty()) book_share(ledger, forces[slot], slot, sum);
  }
  book_contacts(bodies, contacts, islands, ledger);
  book_joints(bodies, islands, ledger);
  for (size_t i = 0; i < bodies.size(); ++i)
    (mean_[i].jointed ? drawn : projection).balance -= held_[i].dot(shifted_[i]);
  ledger.book(LedgerLine::projection, projection);
  ledger.book(LedgerLine::joints, drawn);
}

void RealtimeBooks::corrected(std::span<const RigidBody> bodies, LedgerLine line, Ledger& ledger) {
  LedgerEntry sum;
  for (size_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& b = bodies[i];
    Motion& was = last_[i];
    if (!b.dynamic() || (b.v == was.v && b.omega == was.omega && b.pose.x == was.pose.x &&
                         b.pose.q.coeffs() == was.pose.q.coeffs()))
      continue;
    const Vec3 spin = b.inertia_world() * b.omega;
    const Vec3 spin_before = rotated_inertia(b, was.pose.q) * was.omega;
    const auto energy = [&b](const Vec3& v, const Vec3& omega, const Vec3& L) {
      return 0.5 * b.mass * v.squaredNorm() + 0.5 * omega.dot(L);
    };
    LedgerEntry e;
    e.work = energy(b.v, b.omega, spin) - energy(was.v, was.omega, spin_before);
    e.balance = e.work - held_[i].dot(b.pose.x - was.pose.x);
    e.momentum = b.mass * (b.v - was.v);
    e.angular_momentum =
        b.mass * (b.pose.x.cross(b.v) - was.pose.x.cross(was.v)) + spin - spin_before;
    sum.add(e);
    was = {b.pose, b.v, b.omega};
  }
  ledger.book(line, sum);
}

void RealtimeBooks::particles(std::span<const ParticleSystem> systems,
                              const std::vector<std::optional<ForceDef>>& forces,
                              const Vec3& gravity, double h, const ParticleBlocks& blocks,
                              Ledger& ledger) const {
  LedgerEntry weight;
  const auto mean = [&](const ParticleSystem& p, size_t i) -> Vec3 {
    return p.v[i] + 0.5 * h * (p.gravity_scale * gravity + p.force[i] / p.mass[i]);
  };
  const auto push_particle = [&](const ParticleSystem& p, size_t i, const Vec3& force) {
    const Vec3 v = mean(p, i), impulse = h * force;
    return LedgerEntry{impulse.dot(v), 0, impulse, (p.x[i] + 0.5 * h * v).cross(impulse)};
  };
  for (size_t s = 0; s < systems.size(); ++s) {
    const ParticleSystem& p = systems[s];
    if (blocks.has_blocks(s)) continue;
    for (size_t i = 0; i < p.size(); ++i)
      weight.add(push_particle(p, i, p.mass[i] * p.gravity_scale * gravity));
  }
  ledger.book(LedgerLine::gravity, weight);
  for (uint32_t slot = 0; slot < shares.size(); ++slot) {
    if (shares[slot].particles.empty()) continue;
    LedgerEntry sum;
    for (const ForceShare::OnParticle& on : shares[slot].particles)
      sum.add(push_particle(systems[on.system], on.index, on.force));
    sum.balance = (1 - shares[slot].conserved) * sum.work;
    book_share(ledger, forces[slot], slot, sum);
  }
}

}  // namespace tumble
