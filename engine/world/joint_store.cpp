#include "engine/world/joint_store.hpp"

namespace tumble {
namespace {

void write_frame(ByteWriter& out, const Pose& frame) {
  out.value(frame.x);
  out.value(frame.q.coeffs());
}

void read_frame(ByteReader& in, Pose& frame) {
  in.value(frame.x);
  in.value(frame.q.coeffs());
}

}  // namespace

void write_joint_def(ByteWriter& out, const JointDef& def) {
  out.text(def.name);
  out.value(def.kind);
  out.value(def.a);
  out.value(def.b);
  write_frame(out, def.frame_a);
  write_frame(out, def.frame_b);
  out.value(def.length);
  out.value(uint8_t{def.collide});
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
  if (in.ok() && !validate(def)) in.fail();
  return def;
}

void JointStore::put(JointId id, const JointDef& def, const BodySet& bodies) {
  if (joints.size() <= id.index) {
    joints.resize(id.index + 1);
    defs.resize(id.index + 1);
  }
  joints[id.index] = make_joint(def, bodies);
  defs[id.index] = def;
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
  }
}

void JointStore::load(ByteReader& in, const BodySet& bodies) {
  if (!ids.load(in)) return in.fail();
  joints.assign(ids.capacity(), {});
  defs.assign(ids.capacity(), {});
  for (uint32_t i = 0; i < ids.capacity() && in.ok(); ++i) {
    if (!ids.alive(i)) continue;
    const JointDef def = read_joint_def(in);
    const bool ties = bodies.find(def.b) && (def.a.is_null() || bodies.find(def.a));
    if (!in.ok() || !ties) return in.fail();
    put(ids.at(i), def, bodies);
    in.value(joints[i].moving_force);
    in.value(joints[i].relaxing_force);
  }
}

JointId ReservedJoints::allocate(const JointDef& def) {
  const JointId id = ids_.allocate();
  if (ends_.size() <= id.index) ends_.resize(id.index + 1);
  change(id, def);
  return id;
}

void ReservedJoints::change(JointId id, const JointDef& def) {
  ends_[id.index] = {def.a, def.b};
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
  }
}

void ReservedJoints::load(ByteReader& in) {
  if (!ids_.load(in)) return in.fail();
  ends_.assign(ids_.capacity(), {});
  for (Ends& e : ends_) {
    in.value(e.a);
    in.value(e.b);
  }
}

}  // namespace tumble
