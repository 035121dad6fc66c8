#include "engine/world/ledger/realtime_books.hpp"

#include "engine/core/chunks.hpp"
#include "engine/core/prefetch.hpp"
#include "engine/dynamics/realtime/continuous.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

namespace tumble {

void book_share(Ledger& ledger, const std::optional<ForceDef>& def, uint32_t slot,
                const LedgerEntry& e) {
  if (def && std::holds_alternative<MouseSpringDef>(*def))
    ledger.book(LedgerLine::user, e);
  else
    ledger.book_force(slot, e);
}

namespace {

Vec3 angular_momentum(const RigidBody& b, const Quat& q, const Vec3& omega) {
  const Mat3 R = q.toRotationMatrix();
  return (R * b.inertia_body * R.transpose()) * omega;
}

void add(const std::array<LedgerEntry, chunk_count>& chunks, LedgerEntry& sum) {
  for (const LedgerEntry& e : chunks) sum.add(e);
}

}  // namespace

void RealtimeBooks::begin_part(std::span<const RigidBody> bodies,
                               std::span<const uint32_t> involved, Crew& crew) {
  joint_energy_ = joints.energy;
  involved_.assign(involved.begin(), involved.end());
  last_.resize(bodies.size());
  for_chunks(&crew, involved_.size(), [&](size_t, size_t first, size_t last) {
    for (size_t k = first; k < last; ++k) {
      prefetch<128>(&bodies[involved_[std::min(k + 8, last - 1)]]);
      const uint32_t i = involved_[k];
      last_[i] = {bodies[i].pose, bodies[i].v, bodies[i].omega};
    }
  });
}

RealtimeBooks::Mean RealtimeBooks::mean_of(const Part& part, uint32_t slot,
                                           const Motion& start) const {
  const RigidBody& b = part.bodies[slot];
  const uint32_t in = part.islands.island_of[slot];
  Mean m{0.5 * (start.pose.x + b.pose.x),
         0.5 * (start.v + b.v),
         0.5 * (start.omega + b.omega),
         start.pose.q.toRotationMatrix(),
         b.mass,
         b.dynamic(),
         b.dynamic() && in != 0};
  if (b.type == BodyType::fixed) m.v = m.omega = Vec3::Zero();
  if (in == 0 || b.torque.isZero(0)) return m;
  const Island& island = part.islands.islands[in - 1];
  if (island.contact_begin < island.contact_end || island.joint_begin < island.joint_end) return m;
  // A body without contacts and joints rotates freely after the impulse of its torque, which is all
  // that does work on its rotation.
  const Vec3 torque_body = m.axes.transpose() * b.torque;
  m.omega = start.omega + 0.5 * part.h * (m.axes * (b.inverse_inertia_body * torque_body));
  return m;
}

LedgerEntry RealtimeBooks::push(uint32_t slot, const Vec3& impulse, const Vec3& moment) const {
  const Mean& m = mean_[slot];
  if (!m.dynamic) return {};
  const double work = impulse.dot(m.v) + moment.dot(m.omega);
  return {work, work, impulse, m.x.cross(impulse) + moment};
}

/// Books uniform gravity, and prepares `mean_` and the other arrays by body for the rest of the
/// booking.
void RealtimeBooks::book_weights(const Part& part, Ledger& ledger, Crew& crew) {
  const size_t n = part.bodies.size();
  mean_.resize(n);
  shifted_.resize(n);
  held_.resize(n);
  touch_.resize(n);
  std::array<LedgerEntry, chunk_count> weights;
  for_chunks(&crew, involved_.size(), [&](size_t chunk, size_t first, size_t last) {
    LedgerEntry weight;
    for (size_t k = first; k < last; ++k) {
      const uint32_t i = involved_[k];
      touch_[i] = Touch::nothing;
      const RigidBody& b = part.bodies[i];
      Motion& motion = last_[i];
      Mean& m = mean_[i] = mean_of(part, i, motion);
      if (m.moved) {
        held_[i] = b.mass * b.gravity_scale * part.gravity;
        shifted_[i] = b.pose.x - motion.pose.x - part.h * m.v;
        weight.add(push(i, part.h * held_[i], Vec3::Zero()));
      } else {
        held_[i] = shifted_[i] = Vec3::Zero();
      }
      motion = {b.pose, b.v, b.omega};
    }
    weights[chunk] = weight;
  });
  LedgerEntry sum;
  add(weights, sum);
  sum.balance = 0;
  ledger.book(LedgerLine::gravity, sum);
}

void RealtimeBooks::book_shares(const Part& part, Ledger& ledger) {
  for (uint32_t slot = 0; slot < shares.size(); ++slot) {
    LedgerEntry sum;
    for (const ForceShare::OnBody& on : shares[slot].bodies) {
      if (part.islands.island_of[on.slot] == 0) continue;
      LedgerEntry e = push(on.slot, part.h * on.force, Vec3::Zero());
      const Vec3 lost = on.force - on.held, lost_torque = on.torque - on.held_torque;
      const Vec3& omega = mean_[on.slot].omega;
      e.work += part.h * on.torque.dot(omega);
      e.balance = push(on.slot, part.h * lost, part.h * lost_torque).work;
      e.angular_momentum += part.h * on.torque;
      sum.add(e);
      held_[on.slot] += on.held;
    }
    if (shares[slot].bodies.empty()) continue;
    if (slot < part.forces.size())
      book_share(ledger, part.forces[slot], slot, sum);
    else
      ledger.book(LedgerLine::sph_pressure, sum);
  }
}

void RealtimeBooks::book_push(const Contact& c, const Push& push_of, const Vec3& belt,
                              LedgerEntry& line, LedgerEntry& kinematic) const {
  const Mean &a = mean_[c.key.body_a], &b = mean_[c.key.body_b];
  const auto& [P, moment_a, moment_b] = push_of;
  const double lost = P.dot(b.v - a.v - belt) + moment_b.dot(b.omega) - moment_a.dot(a.omega);
  line.work += lost;
  // Fixed and kinematic bodies do work by their own velocity, and belts by theirs.
  kinematic.work += P.dot(belt);
  if (a.dynamic && b.dynamic) {
    line.angular_momentum += (b.x - a.x).cross(P) + (moment_b - moment_a);
  } else if (b.dynamic) {
    line.momentum += P;
    line.angular_momentum += b.x.cross(P) + moment_b;
    kinematic.work += P.dot(a.v) + moment_a.dot(a.omega);
  } else {
    line.momentum -= P;
    line.angular_momentum -= a.x.cross(P) + moment_a;
    kinematic.work -= P.dot(b.v) + moment_b.dot(b.omega);
  }
}

void RealtimeBooks::book_contact(const Contact& c, ContactLines& lines) const {
  const Mat3 &axes_a = mean_[c.key.body_a].axes, &axes_b = mean_[c.key.body_b].axes;
  Push friction;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  // means weighted by the normal impulses
  double pressure = 0;
  for (const ContactPoint& p : c.used()) {
    const Vec3 ra = axes_a * p.anchor_a, rb = axes_b * p.anchor_b;
    pressure += p.normal_impulse;
    arm_a += p.normal_impulse * ra;
    arm_b += p.normal_impulse * rb;
    friction.impulse += p.friction_impulse;
    friction.moment_a += ra.cross(p.friction_impulse);
    friction.moment_b += rb.cross(p.friction_impulse);
  }
  const Push normal{pressure * c.normal, arm_a.cross(c.normal), arm_b.cross(c.normal)};
  book_push(c, normal, Vec3::Zero(), lines.normal, lines.kinematic);
  book_push(c, friction, c.surface_velocity, lines.friction, lines.kinematic);
  const Vec3& turning = c.turning_impulse;
  if (turning.isZero(0)) return;
  book_push(c, {Vec3::Zero(), turning, turning}, Vec3::Zero(), lines.friction, lines.kinematic);
}

void RealtimeBooks::book_contacts(const Part& part, Ledger& ledger, Crew& crew) {
  std::array<ContactLines, chunk_count> lines_of;
  const std::span<const Contact> contacts = part.contacts.contacts();
  const std::span<const uint32_t> which = part.islands.contacts;
  // Several contacts, possibly on different threads, may mark the same body.
  const auto press = [this](uint32_t slot) {
    std::atomic_ref touch(touch_[slot]);
    if (touch.load(std::memory_order_relaxed) != Touch::contact)
      touch.store(Touch::contact, std::memory_order_relaxed);
  };
  for_chunks(&crew, which.size(), [&](size_t chunk, size_t first, size_t last) {
    constexpr size_t ahead = 6;
    ContactLines lines;
    for (size_t k = first; k < last; ++k) {
      prefetch<sizeof(ContactHead) + sizeof(ContactPoint)>(
          &contacts[which[std::min(k + ahead, last - 1)]]);
      const Contact& c = contacts[which[k]];
      const bool pressed = c.pressed();
      if (pressed) press(c.key.body_a), press(c.key.body_b);
      if (pressed || !c.turning_impulse.isZero(0)) book_contact(c, lines);
    }
    lines_of[chunk] = lines;
  });
  ContactLines sum;
  for (const ContactLines& lines : lines_of) {
    sum.normal.add(lines.normal);
    sum.friction.add(lines.friction);
    sum.kinematic.add(lines.kinematic);
  }
  for (LedgerEntry* line : {&sum.normal, &sum.friction, &sum.kinematic}) line->balance = line->work;
  ledger.book(LedgerLine::restitution, sum.normal);
  ledger.book(LedgerLine::friction, sum.friction);
  ledger.book(LedgerLine::kinematic, sum.kinematic);
}

void RealtimeBooks::book_joints(const Part& part, Ledger& ledger) {
  LedgerEntry line, kinematic;
  double motors = 0, friction = 0, limits = 0;
  for (const uint32_t k : part.islands.joints) {
    const Joint& joint = joints.joints[k];
    for (const uint32_t slot : {joint.a, joint.b})
      if (slot != no_body && touch_[slot] == Touch::nothing) touch_[slot] = Touch::joint_only;
    const Vec3 &P = joints.pushes[k].impulse, &moment_a = joints.pushes[k].moment_a,
               &moment_b = joints.pushes[k].moment_b;
    const Mean& b = mean_[joint.b];
    LedgerEntry e = push(joint.b, P, moment_b);
    double work = P.dot(b.v) + moment_b.dot(b.omega);
    if (joint.a != no_body) {
      const Mean& a = mean_[joint.a];
      e.add(push(joint.a, -P, moment_a));
      work += moment_a.dot(a.omega) - P.dot(a.v);
    }
    // As for contacts: the rest is work of fixed and kinematic bodies by their own velocity.
    kinematic.work += e.work - work;
    e.work = e.balance = work;
    line.add(e);
    const JointPush& push = joints.pushes[k];
    motors += push.motors;
    friction += push.friction;
    limits += push.limits;
  }
  for (const auto& [of, work] :
       {std::pair{LedgerLine::motors, motors}, std::pair{LedgerLine::friction, friction},
        std::pair{LedgerLine::restitution, limits}}) {
    LedgerEntry entry;
    entry.work = entry.balance = work;
    ledger.book(of, entry);
    line.work -= work;
    line.balance -= work;
  }
  // Energy stored in springs and armatures is not lost.
  line.balance += joints.energy - joint_energy_;
  kinematic.balance = kinematic.work;
  ledger.book(LedgerLine::joints, line);
  ledger.book(LedgerLine::kinematic, kinematic);
}

/// Books displacements beyond the mean velocity, where contacts or joints held a body.
void RealtimeBooks::book_shifts(Ledger& ledger, Crew& crew) const {
  std::array<LedgerEntry, chunk_count> projections, draws;
  for_chunks(&crew, involved_.size(), [&](size_t chunk, size_t first, size_t last) {
    LedgerEntry projection, drawn;
    for (size_t k = first; k < last; ++k) {
      const uint32_t i = involved_[k];
      if (touch_[i] == Touch::nothing || !mean_[i].moved) continue;
      LedgerEntry& line = touch_[i] == Touch::contact ? projection : drawn;
      line.balance -= held_[i].dot(shifted_[i]);
      line.angular_momentum += shifted_[i].cross(mean_[i].mass * mean_[i].v);
    }
    projections[chunk] = projection;
    draws[chunk] = drawn;
  });
  LedgerEntry projection, drawn;
  add(projections, projection);
  add(draws, drawn);
  ledger.book(LedgerLine::projection, projection);
  ledger.book(LedgerLine::joints, drawn);
}

void RealtimeBooks::end_part(const Part& part, Ledger& ledger, Crew& crew) {
  book_weights(part, ledger, crew);
  book_shares(part, ledger);
  book_contacts(part, ledger, crew);
  book_joints(part, ledger);
  book_shifts(ledger, crew);
}

void RealtimeBooks::corrected(std::span<const RigidBody> bodies, LedgerLine line, Ledger& ledger,
                              Crew& crew) {
  corrected(bodies, involved_, line, ledger, crew);
}

void RealtimeBooks::put_back(std::span<const RigidBody> bodies, const ContinuousStage& stage,
                             const Vec3& gravity, Ledger& ledger, Crew& crew) {
  for (const uint32_t i : stage.woken()) {
    last_[i] = {stage.start_of(i), Vec3::Zero(), Vec3::Zero()};
    held_[i] = bodies[i].mass * bodies[i].gravity_scale * gravity;
  }
  corrected(bodies, stage.carried(), LedgerLine::kinematic, ledger, crew);
  corrected(bodies, involved_, LedgerLine::projection, ledger, crew);
}

void RealtimeBooks::corrected(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                              LedgerLine line, Ledger& ledger, Crew& crew) {
  const auto change = [](const RigidBody& b, const Motion& was, bool turned, const Vec3& held) {
    LedgerEntry e;
    const Mat3 inertia = b.inertia_world();
    const Vec3 spin = inertia * b.omega;
    const Vec3 spin_before =
        turned ? angular_momentum(b, was.pose.q, was.omega) : Vec3(inertia * was.omega);
    const auto energy = [&b](const Vec3& v, const Vec3& omega, const Vec3& L) {
      return 0.5 * b.mass * v.squaredNorm() + 0.5 * omega.dot(L);
    };
    e.work = energy(b.v, b.omega, spin) - energy(was.v, was.omega, spin_before);
    e.balance = e.work - held.dot(b.pose.x - was.pose.x);
    e.momentum = b.mass * (b.v - was.v);
    e.angular_momentum =
        b.mass * (b.pose.x.cross(b.v) - was.pose.x.cross(was.v)) + spin - spin_before;
    return e;
  };
  std::array<LedgerEntry, chunk_count> changes;
  for_chunks(&crew, slots.size(), [&](size_t chunk, size_t first, size_t last) {
    LedgerEntry sum;
    for (size_t k = first; k < last; ++k) {
      const uint32_t i = slots[k];
      const RigidBody& b = bodies[i];
      Motion& was = last_[i];
      const bool turned = b.pose.q.coeffs() != was.pose.q.coeffs();
      const bool same = !turned && b.v == was.v && b.omega == was.omega && b.pose.x == was.pose.x;
      if (same || !b.dynamic()) continue;
      sum.add(change(b, was, turned, held_[i]));
      was = {b.pose, b.v, b.omega};
    }
    changes[chunk] = sum;
  });
  LedgerEntry sum;
  add(changes, sum);
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
    if (blocks.has_blocks(s) || p.fluid || p.grains) continue;
    for (size_t i = 0; i < p.size(); ++i)
      weight.add(push_particle(p, i, p.mass[i] * p.gravity_scale * gravity));
  }
  ledger.book(LedgerLine::gravity, weight);
  for (uint32_t slot = 0; slot < shares.size(); ++slot) {
    if (shares[slot].particles.empty()) continue;
    LedgerEntry sum;
    for (const ForceShare::OnParticle& on : shares[slot].particles) {
      const ParticleSystem& p = systems[on.system];
      if (p.fluid || p.grains) continue;  // booked where they are moved
      LedgerEntry e = push_particle(p, on.index, on.force);
      e.balance = h * (on.force - on.held).dot(mean(p, on.index));
      sum.add(e);
    }
    book_share(ledger, forces[slot], slot, sum);
  }
}

}  // namespace tumble
