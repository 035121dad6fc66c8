#include "engine/world/shown_state.hpp"

#include "engine/world/world.hpp"

namespace tumble {
namespace {

constexpr uint32_t shown_version = 1;

Error damaged_state() {
  return {ErrorCode::parse, "the state is damaged, or of another version of Tumble", {}, {}};
}

/// Calls f for every count of a step that frames have and snapshots have not.
template <class Stats, class F>
void for_counts(Stats& s, const F& f) {
  for (auto* count : {&s.bodies, &s.awake, &s.particles, &s.islands, &s.bounds_tested,
                      &s.pairs_found, &s.pairs, &s.contacts, &s.contact_points, &s.events,
                      &s.impacts, &s.fallbacks, &s.time_stepped, &s.joints, &s.broken_joints})
    f(*count);
}

/// Calls f for every member.
template <class ContactFrame, class F>
void for_members(ContactFrame& c, const F& f) {
  f(c.system);
  f(c.particle);
  f(c.body);
  f(c.shape);
  f(c.other);
  f(c.other_particle);
  f(c.x_world);
  f(c.normal);
  f(c.gap);
  f(c.time);
}

void write_particle_contacts(ByteWriter& out, const Frame& frame) {
  out.value(uint8_t{frame.particle_contacts != nullptr});
  if (!frame.particle_contacts) return;
  out.value(uint64_t(frame.particle_contacts->size()));
  for (const ParticleContactFrame& c : *frame.particle_contacts) {
    for_members(c, [&out](const auto& member) { out.value(member); });
    out.value(uint8_t{c.apart_again});
  }
}

void read_particle_contacts(ByteReader& in, Frame& frame) {
  frame.particle_contacts.reset();
  if (in.get<uint8_t>() == 0) return;
  auto contacts = std::make_shared<std::vector<ParticleContactFrame>>();
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    ParticleContactFrame& c = contacts->emplace_back();
    for_members(c, [&in](auto& member) { in.value(member); });
    c.apart_again = in.get<uint8_t>() != 0;
  }
  frame.particle_contacts = std::move(contacts);
}

void write_bodies_shown(ByteWriter& out, const Frame& frame) {
  out.value(uint64_t(frame.body_slots()));
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    out.value(frame.body(slot).island);
    out.value(uint8_t{frame.body(slot).jumped});
  }
}

/// The frame's chunks are replaced: they may be shared with others.
void read_bodies_shown(ByteReader& in, Frame& frame) {
  if (in.get<uint64_t>() != frame.body_slots()) return in.fail();
  for (size_t first = 0; first < frame.body_slots(); first += Frame::chunk_size) {
    auto& chunk = frame.chunks[first / Frame::chunk_size];
    auto shown = std::make_shared<Frame::BodyChunk>(*chunk);
    for (size_t i = 0; i < Frame::chunk_size && first + i < frame.body_slots(); ++i) {
      in.value((*shown)[i].island);
      (*shown)[i].jumped = in.get<uint8_t>() != 0;
    }
    chunk = std::move(shown);
  }
}

void write_fluid_forces(ByteWriter& out, const Frame& frame) {
  out.value(uint64_t(frame.fluid_forces.size()));
  for (const FluidForceFrame& f : frame.fluid_forces) {
    out.value(f.body);
    out.value(f.force);
    out.value(f.torque);
  }
}

void read_fluid_forces(ByteReader& in, Frame& frame) {
  frame.fluid_forces.clear();
  const auto count = in.get<uint64_t>();
  for (uint64_t i = 0; i < count && in.ok(); ++i) {
    FluidForceFrame& f = frame.fluid_forces.emplace_back();
    in.value(f.body);
    in.value(f.force);
    in.value(f.torque);
  }
}

}  // namespace

Bytes save_shown(const World& world, bool with_geometry) {
  const auto frame = world.frame();
  const Bytes snapshot = world.save(with_geometry);
  ByteWriter out;
  out.begin_section("shown", shown_version);
  write_bodies_shown(out, *frame);
  write_particle_contacts(out, *frame);
  write_fluid_forces(out, *frame);
  for_counts(frame->stats, [&out](uint64_t count) { out.value(count); });
  out.value(frame->stats.max_penetration);
  out.end_section();
  Bytes bytes = out.take();
  ByteWriter size;
  size.value(uint64_t(bytes.size()));
  bytes.insert(bytes.begin(), size.bytes().begin(), size.bytes().end());
  bytes.insert(bytes.end(), snapshot.begin(), snapshot.end());
  return bytes;
}

std::span<const std::byte> snapshot_of(std::span<const std::byte> shown) {
  ByteReader in(shown);
  const auto size = in.get<uint64_t>();
  if (!in.ok() || size > in.remaining()) return {};
  return shown.subspan(sizeof(uint64_t) + size_t(size));
}

Result<std::shared_ptr<Frame>> load_shown(World& world, std::span<const std::byte> bytes) {
  const auto snapshot = snapshot_of(bytes);
  if (snapshot.empty()) return damaged_state();
  ByteReader in(bytes.subspan(sizeof(uint64_t)));
  if (in.begin_section("shown") != shown_version) return damaged_state();
  if (Status loaded = world.load(snapshot); !loaded) return loaded.error();
  auto frame = std::make_shared<Frame>(*world.frame());
  read_bodies_shown(in, *frame);
  read_particle_contacts(in, *frame);
  read_fluid_forces(in, *frame);
  for_counts(frame->stats, [&in](uint64_t& count) { in.value(count); });
  in.value(frame->stats.max_penetration);
  in.end_section();
  if (!in.ok()) return damaged_state();
  return frame;
}

}  // namespace tumble
