#include "engine/world/joint_store.hpp"

#include "engine/math/time_course.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

void write_frame(ByteWriter& out, const Pose& frame) {
  out.value(frame.x);
  out.value(frame.q.coeffs());
}

/// Calls f for every numeric parameter of a drive.
template <class Drive, class F>
void for_drive_numbers(Drive& d, const F& f) {
  for (auto* x : {&d.limits.lower, &d.limits.upper, &d.limits.stiffness, &d.limits.damping,
                  &d.limits.restitution, &d.motor.target, &d.motor.stiffness, &d.motor.damping,
                  &d.motor.max_force, &d.spring.stiffness, &d.spring.damping, &d.spring.rest,
                  &d.friction, &d.armature})
    f(*x);
}

void write_drive(ByteWriter& out, const CoordinateDrive& drive) {
  out.value(drive.motor.kind);
  for_drive_numbers(drive, [&out](double x) { out.value(x); });
  write_course(out, drive.motor.course);
  out.value(uint8_t{drive.couple.has_value()});
  if (!drive.couple) return;
  out.value(drive.couple->joint);
  out.value(drive.couple->coordinate);
  out.value(drive.couple->ratio);
  out.value(drive.couple->offset);
}

void read_drive(ByteReader& in, CoordinateDrive& drive) {
  in.value(drive.motor.kind);
  if (drive.motor.kind > MotorKind::force) in.fail();
  for_drive_numbers(drive, [&in](double& x) { in.value(x); });
  drive.motor.course = read_course(in);
  if (in.get<uint8_t>() == 0) return;
  CoordinateCouple& couple = drive.couple.emplace();
  in.value(couple.joint);
  in.value(couple.coordinate);
  in.value(couple.ratio);
  in.value(couple.offset);
}

/// Whether a joint that is redefined may keep its state.
bool same_ends(const Joint& a, const Joint& b) {
  return a.kind == b.kind && a.a == b.a && a.b == b.b;
}

/// Whether it ties a body that its forces can move.
bool moves_any(const Joint& joint, std::span<const RigidBody> bodies) {
  const auto moves = [bodies](uint32_t slot) { return slot != no_body && bodies[slot].dynamic(); };
  return moves(joint.a) || moves(joint.b);
}

/// Inserts a number into an ascending list, or removes it.
void note(uint32_t slot, bool in, std::vector<uint32_t>& list) {
  const auto at = std::ranges::lower_bound(list, slot);
  const bool is = at != list.end() && *at == slot;
  if (in && !is) list.insert(at, slot);
  if (!in && is) list.erase(at);
}

void read_frame(ByteReader& in, Pose& frame) {
  in.value(frame.x);
  in.value(frame.q.coeffs());
}

}  // namespace

JointEnergies energy_of_joints(std::span<const Joint> joints, std::span<const uint32_t> which,
                               std::span<const RigidBody> bodies) {
  JointEnergies sum;
  for (const uint32_t slot : which) {
    const JointEnergies one = energy_of_joints(joints.subspan(slot, 1), bodies);
    sum.potential += one.potential;
    sum.kinetic += one.kinetic;
  }
  return sum;
}

void write_joint_def(ByteWriter& out, const JointDef& def) {
  out.text(def.name);
  out.value(def.kind);
  out.value(def.a);
  out.value(def.b);
  write_frame(out, def.frame_a);
  write_frame(out, def.frame_b);
  out.value(def.length);
  out.value(uint8_t{def.collide});
  for (const CoordinateDrive& drive : def.drives) write_drive(out, drive);
  out.value(def.break_force);
  out.value(def.break_torque);
}

JointDef read_joint_def(ByteReader& in) {
  JointDef def;
  in.text(def.name);
  in.value(def.kind);
  in.value(def.a);
  in.value(def.b);
  read_frame(in, def.frame_a);
  read_frame(in, def.frame_b);
  in.value(def.length);
  def.collide = in.get<uint8_t>() != 0;
  for (CoordinateDrive& drive : def.drives) read_drive(in, drive);
  in.value(def.break_force);
  in.value(def.break_torque);
  if (in.ok() && !validate(def)) in.fail();
  return def;
}

void JointStore::put(JointId id, const JointDef& def, const BodySet& bodies) {
  if (joints.size() <= id.index) {
    joints.resize(id.index + 1);
    defs.resize(id.index + 1);
  }
  Joint made = make_joint(def, bodies);
  const Joint& old = joints[id.index];
  if (same_ends(made, old)) {
    // What it did to bodies that can no longer move says nothing any more.
    if (moves_any(made, bodies.bodies)) {
      made.moving_force = old.moving_force;
      made.relaxing_force = old.relaxing_force;
      made.motor_impulse = old.motor_impulse;
      made.impulse = old.impulse;
    }
    made.value = old.value;
    follow_coordinates(made, bodies.bodies, 0);
  }
  joints[id.index] = std::move(made);
  defs[id.index] = def;
  loops_.reset();
  note(id.index, joints[id.index].followed() || def.breaks(), watched);
  const auto follows = [](const CoordinateDrive& d) { return d.couple.has_value(); };
  note(id.index, std::ranges::any_of(def.drives, follows), followers_);
  const auto varies = [](const CoordinateDrive& d) { return d.motor.course != nullptr; };
  note(id.index, std::ranges::any_of(def.drives, varies), timed);
  couple();
}

/// Rebuilds the couplings. Those that existed keep their forces; one whose other joint does not
/// exist, or has no such coordinate, is left out.
void JointStore::couple() {
  if (followers_.empty() && couplings.empty()) return;
  const std::vector<JointCoupling> before = std::exchange(couplings, {});
  for (const JointCoupling& c : before) joints[c.a].coupled = joints[c.b].coupled = 0;
  for (const uint32_t slot : followers_)
    for (uint32_t x = 0; x < most_coordinates; ++x)
      if (const auto& couple = defs[slot].drives[x].couple) add_coupling(slot, x, *couple, before);
  const auto watch_joints = [this](std::span<const JointCoupling> some) {
    for (const JointCoupling& c : some)
      for (const uint32_t slot : {c.a, c.b})
        note(slot, ids.alive(slot) && (joints[slot].followed() || defs[slot].breaks()), watched);
  };
  watch_joints(before);
  watch_joints(couplings);
}

void JointStore::add_coupling(uint32_t slot, uint32_t x, const CoordinateCouple& couple,
                              std::span<const JointCoupling> before) {
  const JointId other = couple.joint.is_null() ? ids.at(slot) : couple.joint;
  if (!ids.contains(other) ||
      couple.coordinate >= entry_of(joints[other.index].kind).coordinates.size())
    return;
  JointCoupling& c = couplings.emplace_back();
  c = {slot, other.index, x, couple.coordinate, couple.ratio, couple.offset};
  const auto old = std::ranges::find_if(before, [&](const auto& o) { return o.same(c); });
  if (old != before.end()) {
    c.moving_force = old->moving_force;
    c.relaxing_force = old->relaxing_force;
  }
  joints[c.a].coupled |= uint8_t(1u << c.x);
  joints[c.b].coupled |= uint8_t(1u << c.y);
}

std::vector<std::array<double, most_coordinates>> JointStore::coupling_forces() const {
  std::vector<std::array<double, most_coordinates>> sums;
  if (couplings.empty()) return sums;
  sums.resize(joints.size());
  for (const JointCoupling& c : couplings) {
    sums[c.a][c.x] += c.force();
    sums[c.b][c.y] -= c.ratio * c.force();
  }
  return sums;
}

JointEnergies JointStore::energies(std::span<const RigidBody> bodies) const {
  return energy_of_joints(joints, watched, bodies);
}

void JointStore::release(JointId id) {
  if (!ids.release(id)) return;
  joints[id.index] = {};
  loops_.reset();
  note(id.index, false, watched);
  note(id.index, false, followers_);
  note(id.index, false, timed);
  couple();
}

std::vector<JointId> JointStore::at_body(BodyId body) const {
  std::vector<JointId> out;
  for (uint32_t i = 0; i < ids.capacity(); ++i)
    if (ids.alive(i) && (defs[i].a == body || defs[i].b == body)) out.push_back(ids.at(i));
  return out;
}

void JointStore::add_links(std::vector<BodyLink>& links) const {
  for (uint32_t i = 0; i < ids.capacity(); ++i)
    if (ids.alive(i)) links.push_back({joints[i].a, joints[i].b, i});
  for (const JointCoupling& c : couplings)
    for (const uint32_t a : {joints[c.a].a, joints[c.a].b})
      for (const uint32_t b : {joints[c.b].a, joints[c.b].b})
        if (a != no_body && b != no_body && a != b) links.push_back({a, b});
}

std::vector<JointLoops>& JointStore::loops(std::span<const RigidBody> bodies) {
  if (loops_) return *loops_;
  std::vector<uint32_t> live;
  for (uint32_t i = 0; i < ids.capacity(); ++i)
    if (ids.alive(i)) live.push_back(i);
  return loops_.emplace(find_loops(joints, live, bodies));
}

void JointStore::find_apart(std::span<const RigidBody> bodies, PairFilter& out) const {
  out.clear();
  out.set_groups(bodies);
  for (uint32_t i = 0; i < ids.capacity(); ++i) {
    const Joint& j = joints[i];
    if (ids.alive(i) && !j.collide && j.a != no_body) out.add(j.a, j.b);
  }
  out.sort();
}

void JointStore::save(ByteWriter& out) const {
  ids.save(out);
  for (uint32_t i = 0; i < ids.capacity(); ++i) {
    if (!ids.alive(i)) continue;
    write_joint_def(out, defs[i]);
    out.value(joints[i].moving_force);
    out.value(joints[i].relaxing_force);
    out.value(joints[i].value);
    out.value(joints[i].rate);
    out.value(joints[i].motor_impulse);
    out.value(joints[i].impulse.force);
    out.value(joints[i].impulse.torque);
  }
  for (const JointCoupling& c : couplings) {
    out.value(c.moving_force);
    out.value(c.relaxing_force);
  }
}

void JointStore::load(ByteReader& in, const BodySet& bodies) {
  if (!ids.load(in)) return in.fail();
  joints.assign(ids.capacity(), {});
  defs.assign(ids.capacity(), {});
  couplings.clear();
  followers_.clear();
  timed.clear();
  watched.clear();
  loops_.reset();
  for (uint32_t i = 0; i < ids.capacity() && in.ok(); ++i) {
    if (!ids.alive(i)) continue;
    const JointDef def = read_joint_def(in);
    const bool ties = bodies.find(def.b) && (def.a.is_null() || bodies.find(def.a));
    if (!in.ok() || !ties) return in.fail();
    put(ids.at(i), def, bodies);
    in.value(joints[i].moving_force);
    in.value(joints[i].relaxing_force);
    in.value(joints[i].value);
    in.value(joints[i].rate);
    in.value(joints[i].motor_impulse);
    in.value(joints[i].impulse.force);
    in.value(joints[i].impulse.torque);
  }
  for (JointCoupling& c : couplings) {
    in.value(c.moving_force);
    in.value(c.relaxing_force);
  }
}

JointId ReservedJoints::allocate(const JointDef& def) {
  const JointId id = ids_.allocate();
  if (ends_.size() <= id.index) ends_.resize(id.index + 1);
  change(id, def);
  return id;
}

void ReservedJoints::change(JointId id, const JointDef& def) {
  ends_[id.index] = {def.a, def.b, def.kind};
}

void ReservedJoints::release_at(BodyId body) {
  for (uint32_t i = 0; i < ids_.capacity(); ++i)
    if (ids_.alive(i) && (ends_[i].a == body || ends_[i].b == body)) ids_.release(ids_.at(i));
}

void ReservedJoints::save(ByteWriter& out) const {
  ids_.save(out);
  for (uint32_t i = 0; i < ids_.capacity(); ++i) {
    out.value(ends_[i].a);
    out.value(ends_[i].b);
    out.value(ends_[i].kind);
  }
}

void ReservedJoints::load(ByteReader& in) {
  if (!ids_.load(in)) return in.fail();
  ends_.assign(ids_.capacity(), {});
  for (Ends& e : ends_) {
    in.value(e.a);
    in.value(e.b);
    in.value(e.kind);
    if (size_t(e.kind) >= all_joint_kinds().size()) return in.fail();
  }
}

}  // namespace tumble
