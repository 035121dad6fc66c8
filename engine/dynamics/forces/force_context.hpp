#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

class Crew;
struct ForceTag;
using ForceId = Handle<ForceTag>;

/// Where a force takes hold: a point of the world, of a body, or a particle.
struct Anchor {
  enum class Kind : uint8_t { world, body, particle };
  Kind kind = Kind::world;
  BodyId body;
  ParticleSystemId particles;
  uint64_t particle = 0;  ///< ParticleSystem::id
  /// World: the point in world axes. Body: the point in the definition's body frame [m].
  Vec3 point = Vec3::Zero();
};

/// The anchors of a force: in place, or those of a mesh, which has many.
struct Anchors {
  std::array<Anchor, 2> at;
  size_t count = 0;
  std::span<const Anchor> many = {};

  const Anchor* begin() const { return many.empty() ? at.data() : many.data(); }
  const Anchor* end() const { return many.empty() ? at.data() + count : many.data() + many.size(); }
  bool empty() const { return begin() == end(); }
};

/// What forces see of a world: bodies and particles, not the World. `h` is the tick [s].
struct ForceContext {
  BodySet& bodies;
  HandlePool<ParticleSystemTag>& particle_ids;
  std::vector<ParticleSystem>& particles;
  double h;      ///< tick [s]
  Vec3 gravity;  ///< uniform acceleration, applied by the stepper [m/s2]
  /// Springs see what they hold this far ahead along its velocity [s]: h/2 for steppers that move
  /// by x += h v + h^2 a/2, which then is the leapfrog (drift, kick, drift): second order, no drift
  /// of energy.
  double lead = 0;
  double t = 0;  ///< of the start of the tick; at one moment: of that [s]
  /// Forces as they are at this moment, from the present state alone, for steppers that ask at
  /// every stage of an integrator; otherwise those whose impulse over h neither overshoots nor
  /// blows up.
  bool momentary = false;
  /// At one moment, or if there are any: the slots of the bodies that may be pulled. Particles are
  /// not; of forces with anchors, only those whose dynamic bodies are all among these may be
  /// applied.
  std::span<const uint32_t> only = {};  ///< ascending
  /// By system slot the slot among `bodies` of the block of its first particle, ~0 where particles
  /// are no blocks; empty when no system's are. Blocks follow the bodies while a tick lasts.
  std::span<const uint32_t> particle_slots = {};
  /// Threads for forces with much to do; null: none.
  Crew* crew = nullptr;

  bool only_some() const { return momentary || !only.empty(); }
  bool may_pull(uint32_t slot) const;
  /// Those of `only` that are blocks of a system of particles.
  std::span<const uint32_t> asked_blocks(uint32_t system) const;
};

/// Position and velocity of an anchor now; empty when what it was on is gone.
struct AnchorState {
  Vec3 x_world, v_world;
};
std::optional<AnchorState> locate(const Anchor& anchor, const ForceContext& context);
/// The body that an anchor is on, or the block of its particle; null for other anchors.
RigidBody* pulled_body(const Anchor& anchor, const ForceContext& context);

}  // namespace tumble
