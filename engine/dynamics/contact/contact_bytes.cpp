// Contacts to and from bytes: everything that a later step reads.
#include "engine/dynamics/contact/contact_set.hpp"

#include <algorithm>

namespace tumble {

namespace {

void write(ByteWriter& out, const Vec3& v) {
  out.raw(v.data(), 3 * sizeof(double));
}
void read(ByteReader& in, Vec3& v) {
  in.raw(v.data(), 3 * sizeof(double));
}

void write_pose(ByteWriter& out, const Pose& pose) {
  write(out, pose.x);
  out.value(pose.q.coeffs());
}
void read_pose(ByteReader& in, Pose& pose) {
  read(in, pose.x);
  in.value(pose.q.coeffs());
}

/// The scalars and vectors of a point, in the order of their bytes.
template <class Stream, class Point, class Scalar, class Vector>
void members(Stream& s, Point& p, Scalar scalar, Vector vector) {
  vector(s, p.anchor_a);
  vector(s, p.anchor_b);
  scalar(s, p.gap);
  scalar(s, p.feature);
  scalar(s, p.normal_force);
  vector(s, p.friction_force);
  scalar(s, p.normal_impulse);
  vector(s, p.friction_impulse);
}

/// The two shapes of a pair.
template <class Stream, class Key>
void pair_of(Stream& s, Key& key) {
  s.value(key.body_a);
  s.value(key.shape_a);
  s.value(key.body_b);
  s.value(key.shape_b);
}

const auto put = [](ByteWriter& out, const auto& v) { out.value(v); };
const auto get = [](ByteReader& in, auto& v) { in.value(v); };

}  // namespace

void ContactSet::save(ByteWriter& out) const {
  out.value(uint64_t(size()));
  for (const Contact* contact : all()) {
    const Contact& c = *contact;
    pair_of(out, c.key);
    out.value(c.key.part);
    out.value(c.shapes.a);
    out.value(c.shapes.b);
    write(out, c.normal);
    write(out, c.normal_a);
    out.value(c.friction);
    out.value(c.restitution);
    write(out, c.surface_velocity);
    out.value(c.rounding_a);
    out.value(c.rounding_b);
    out.value(c.rolling_friction);
    out.value(c.torsional_friction);
    write(out, c.turning_torque);
    for (const PolyhedronFeature& f : c.closest) out.value(f.kind), out.value(f.index);
    out.value(int32_t(c.count));
    for (int i = 0; i < c.count; ++i) members(out, c.points[size_t(i)], put, write);
  }
  ContactKnowledge known;
  known.seen = now_.seen;
  known.pieces = now_.pieces;
  resting_.for_piles([&known](const ContactKnowledge& pile) {
    known.seen.insert(known.seen.end(), pile.seen.begin(), pile.seen.end());
    known.pieces.insert(known.pieces.end(), pile.pieces.begin(), pile.pieces.end());
  });
  known.sort();
  out.value(uint64_t(known.seen.size()));
  for (const CachedPair& s : known.seen) {
    pair_of(out, s.pair);
    write_pose(out, s.relative);
    out.value(s.margin);
  }
  out.value(uint64_t(known.pieces.size()));
  for (const CachedShapes& s : known.pieces) {
    pair_of(out, s.pair);
    out.value(s.shapes.a);
    out.value(s.shapes.b);
    write_pose(out, s.relative);
    out.value(s.margin);
    for (const PolyhedronFeature& f : s.closest) out.value(f.kind), out.value(f.index);
    out.value(uint8_t(s.touch));
  }
}

bool ContactSet::load(ByteReader& in, uint32_t body_slots) {
  clear();
  const auto count = in.get<uint64_t>();
  for (uint64_t k = 0; k < count && in.ok(); ++k) {
    Contact c;
    pair_of(in, c.key);
    in.value(c.key.part);
    in.value(c.shapes.a);
    in.value(c.shapes.b);
    read(in, c.normal);
    read(in, c.normal_a);
    in.value(c.friction);
    in.value(c.restitution);
    read(in, c.surface_velocity);
    in.value(c.rounding_a);
    in.value(c.rounding_b);
    in.value(c.rolling_friction);
    in.value(c.torsional_friction);
    read(in, c.turning_torque);
    for (PolyhedronFeature& f : c.closest) in.value(f.kind), in.value(f.index);
    c.count = in.get<int32_t>();
    if (c.count < 0 || c.count > 4 || c.key.body_a >= body_slots || c.key.body_b >= body_slots) {
      in.fail();
      break;
    }
    for (int i = 0; i < c.count; ++i) members(in, c.points[size_t(i)], get, read);
    now_.contacts.push_back(c);
  }
  const auto known = [&](const ContactKey& pair) {
    if (pair.body_a >= body_slots || pair.body_b >= body_slots) in.fail();
  };
  const auto looks = in.get<uint64_t>();
  for (uint64_t k = 0; k < looks && in.ok(); ++k) {
    CachedPair s;
    pair_of(in, s.pair);
    read_pose(in, s.relative);
    in.value(s.margin);
    known(s.pair);
    now_.seen.push_back(s);
  }
  const auto pieces = in.get<uint64_t>();
  for (uint64_t k = 0; k < pieces && in.ok(); ++k) {
    CachedShapes s;
    pair_of(in, s.pair);
    in.value(s.shapes.a);
    in.value(s.shapes.b);
    read_pose(in, s.relative);
    in.value(s.margin);
    for (PolyhedronFeature& f : s.closest) in.value(f.kind), in.value(f.index);
    s.touch = in.get<uint8_t>() != 0;
    known(s.pair);
    now_.pieces.push_back(s);
  }
  if (!in.ok()) clear();
  return in.ok();
}

}  // namespace tumble
