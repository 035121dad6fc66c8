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

/// What one force does to each thing that it acts on. `held` is the part of the force that comes
/// from its potential, `held_torque` that of the torque.
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
  /// What acts on particles that are blocks now acts on bodies.
  void to_blocks(const ParticleBlocks& blocks);
};

/// Adds what a spring's pull does to what it is tied to: to the force sums, and to its share.
void share_pull(const SpringDef& spring, const SpringNet::Pull& pull, ForceContext& context,
                ForceShare& share);
/// The same of what a mesh does to its nodes.
void share_pulls(const SpringMesh& mesh, std::span<const NodePull> pulls, ForceContext& context,
                 ForceShare& share);

/// Springs and meshes among the forces, with their slots.
class SpringsInSlots {
 public:
  void clear();
  /// Takes springs and meshes, and says whether it was one.
  bool add(const ForceDef& def, size_t slot);
  NetSprings all() const { return {springs_, meshes_}; }
  /// Adds their pulls to the force sums, and to their shares by slot.
  void share(const NetPulls& pulls, ForceContext& context, std::vector<ForceShare>& shares) const;

 private:
  std::vector<const SpringDef*> springs_;
  std::vector<const SpringMeshDef*> meshes_;
  std::vector<size_t> spring_slots_, mesh_slots_;
};

/// Force sums before a force acted; memory that is kept.
struct SumsBefore {
  std::vector<Vec3> force, torque;
  std::vector<std::vector<Vec3>> particles;
};

/// Which springs and meshes are taken, by slot; all where it is empty.
using SpringFilter = std::function<bool(size_t slot)>;

/// Adds all forces to the force sums, which begin at zero, and notes the share of each, by slot.
/// Springs come last and all together, as they see the other forces; `supported` as in
/// pull_springs().
void sum_force_shares(const std::vector<std::optional<ForceDef>>& forces, ForceContext& context,
                      std::span<const uint8_t> supported, SumsBefore& scratch,
                      std::vector<ForceShare>& shares, const SpringFilter& filter = {});

}  // namespace tumble
