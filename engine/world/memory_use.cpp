#include "engine/core/memory_use.hpp"

#include "engine/world/state.hpp"
#include "engine/world/world.hpp"

namespace tumble {
namespace {

void add_definitions(const WorldState& s, MemoryUse& use) {
  use.bodies += heap_bytes(s.bodies.bodies, s.body_defs, s.frames.chunks_changed);
  for (const RigidBody& b : s.bodies.bodies) use.bodies += heap_bytes(b.shapes);
  for (const auto& def : s.body_defs)
    if (def) use.bodies += sizeof(BodyDef) + heap_bytes(def->shapes) + def->name.capacity();
  use.joints += heap_bytes(s.joints.joints, s.joints.defs, s.joints.couplings, s.workspace.links);
  use.joints += s.workspace.kept_drives.bytes();
}

/// Adds the memory of the last frame.
void add_frames(const Frame& f, MemoryUse& use) {
  use.bodies += heap_bytes(f.chunks) + f.chunks.size() * sizeof(Frame::BodyChunk);
  use.bodies += heap_bytes(*f.infos);
  for (const BodyInfo& info : *f.infos) use.bodies += heap_bytes(info.shapes);
  use.contacts += heap_bytes(*f.contacts, *f.resting_contacts);
  use.joints += heap_bytes(*f.joints);
}

}  // namespace

MemoryUse World::memory_use() const {
  const WorldState& s = *state_;
  MemoryUse use;
  add_definitions(s, use);
  add_frames(*frame(), use);
  use.bodies +=
      heap_bytes(s.workspace.proxies.proxies, s.workspace.proxies.refs, s.workspace.proxies.first,
                 s.workspace.proxies.owners, s.workspace.proxies.news.moving,
                 s.workspace.proxies.news.settled, s.sums.blocks, s.sums.stale);
  s.roster.add_memory(use);
  use.contacts += heap_bytes(s.workspace.pairs);
  s.contacts.add_memory(use);
  s.islands.add_memory(use);
  s.workspace.solver.add_memory(use);
  s.workspace.continuous.add_memory(use);
  s.workspace.books.add_memory(use);
  s.before.backup.add_memory(use);
  return use;
}

}  // namespace tumble
