#include "engine/world/apart.hpp"

#include "engine/world/state.hpp"

#include <vector>

namespace tumble {

void find_apart(WorldState& s, PairFilter& out) {
  s.joints.find_apart(s.bodies.bodies, out);
  const ForceContext context = s.force_context();
  std::vector<uint32_t> slots;
  bool any = false;
  for (const auto& force : s.forces) {
    const auto* def = force ? std::get_if<SpringMeshDef>(&*force) : nullptr;
    if (!def) continue;
    slots.clear();
    for (const Anchor& node : def->mesh->nodes) {
      const RigidBody* body = pulled_body(node, context);
      slots.push_back(body ? uint32_t(body - s.bodies.bodies.data()) : ParticleBlocks::no_slot);
    }
    for (const SpringMesh::Link& l : def->mesh->links) {
      const uint32_t a = slots[l.a], b = slots[l.b];
      if (a == ParticleBlocks::no_slot || b == ParticleBlocks::no_slot || a == b) continue;
      if (!s.blocks.holds(a) && !s.blocks.holds(b)) continue;  // two bodies that a rope connects
      out.add(a, b);
      any = true;
    }
  }
  if (any) out.sort();
}

}  // namespace tumble
