#pragma once
#include "engine/dynamics/forces/force.hpp"
#include "engine/dynamics/forces/spring_pulls.hpp"
#include "engine/dynamics/particles/particle_blocks.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace tumble {

/// The effect of one force on every body and particle that it acts on. `held` is the conservative
/// part of the force, which comes from its potential; `held_torque` that of the torque.
struct ForceShare {
  struct OnBody {
    uint32_t slot;
    Vec3 force, torque;  ///< [N], [N m]
    Vec3 held = Vec3::Zero(), held_torque = Vec3::Zero();
  };
  struct OnParticle {
    uint32_t system;
    size_t index;
    Vec3 force;  ///< [N]
    Vec3 held = Vec3::Zero();
  };
  std::vector<OnBody> bodies;
  std::vector<OnParticle> particles;

  void clear() {
    bodies.clear();
    particles.clear();
  }
  /// Turns the entries of particles that are blocks now into entries of bodies.
  void to_blocks(const ParticleBlocks& blocks);
};

/// Adds a spring's pull to the force sums of what it is attached to, and to its share.
void share_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context,
                ForceShare& share);
/// Likewise for the pulls of a mesh on its nodes.
void share_pulls(const SpringMesh& mesh, std::span<const NodePull> pulls, ForceContext& context,
                 ForceShare& share);

/// The springs and meshes among the forces, with their slots.
class SpringsInSlots {
 public:
  void clear();
  /// Adds a force if it is a spring or mesh; returns whether it is.
  bool add(const ForceDef& def, size_t slot);
  NetSprings all() const { return {springs_, meshes_}; }
  /// Adds their pulls to the force sums, and to the shares by slot.
  void share(const NetPulls& pulls, ForceContext& context, std::vector<ForceShare>& shares) const;

 private:
  std::vector<const SpringDef*> springs_;
  std::vector<const SpringMeshDef*> meshes_;
  std::vector<size_t> spring_slots_, mesh_slots_;
};

/// Copy of the force sums before a force is applied; its memory is reused.
struct SumsBefore {
  std::vector<Vec3> force, torque;
  std::vector<std::vector<Vec3>> particles;
};

/// Selects springs and meshes by slot; empty: all.
using SpringFilter = std::function<bool(size_t slot)>;

/// Adds all forces to the force sums, which must be zero at the start, and stores the share of
/// each, by slot. Springs are evaluated last and together, because they are solved for implicitly
/// under the other forces; `supported` as in pull_springs().
void sum_force_shares(const std::vector<std::optional<ForceDef>>& forces, ForceContext& context,
                      std::span<const uint8_t> supported, SumsBefore& scratch,
                      std::vector<ForceShare>& shares, const SpringFilter& filter = {});

}  // namespace tumble
