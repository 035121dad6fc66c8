#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// Particles as bodies: blocks of three degrees of freedom, each a ball of the particle's radius
/// with mass but without inertia, which never rotates. They are appended to the bodies during a
/// tick; between ticks there are none.
///
/// Under the event stepper forces on a particle act at its centre, as if the other surface were
/// farther out by the radius, so that contacts of a particle and a body conserve angular momentum.
/// Friction between two particles does not, since neither can rotate.
class ParticleBlocks {
 public:
  static constexpr uint32_t no_slot = ~uint32_t{0};
  enum class Which : uint8_t {
    not_fast,
    colliding
  };  ///< colliding ones are neither fast nor grains

  /// Whether a system gets blocks.
  static bool has_blocks(Which which, const ParticleSystem& system);
  /// Appends the particles of the systems, with the forces on them; those of systems that do not
  /// collide have no shapes.
  Status append(Which which, const HandlePool<ParticleSystemTag>& ids,
                std::span<const ParticleSystem> systems, std::vector<RigidBody>& bodies);
  /// Copies the motion of the blocks over h seconds to the systems, and clears their forces.
  void give_back(std::span<const RigidBody> bodies, double h,
                 std::span<ParticleSystem> systems) const;
  /// Removes the blocks.
  void remove(std::vector<RigidBody>& bodies);

  /// By system slot: slot of its first particle; no_slot for systems without blocks.
  std::span<const uint32_t> first_slots() const { return first_of_; }
  bool has_blocks(size_t system) const {
    return system < first_of_.size() && first_of_[system] != no_slot;
  }
  bool empty() const { return owners_.empty(); }
  bool holds(uint32_t slot) const { return slot >= first_ && slot - first_ < owners_.size(); }
  ParticleName name(uint32_t slot) const { return owners_[slot - first_]; }
  /// Slot of a particle; no_slot if it is gone or has no block.
  uint32_t slot_of(const ParticleName& name, std::span<const ParticleSystem> systems) const;

  /// Slots of blocks are valid for one tick only: between ticks contacts refer to particles by
  /// their index in a list of names, with particle_bit.
  template <class ContactType>
  void store_contacts(std::vector<ContactType>& contacts, std::vector<ParticleName>& names) const {
    names.clear();
    for (ContactType& c : contacts)
      for (uint32_t* slot : {&c.key.body_a, &c.key.body_b}) {
        if (!holds(*slot)) continue;
        names.push_back(name(*slot));
        *slot = particle_bit | uint32_t(names.size() - 1);
      }
  }
  /// The reverse; drops contacts of particles that are gone or have no blocks.
  template <class ContactType>
  void restore_contacts(std::span<const ParticleSystem> systems,
                        std::span<const ParticleName> names,
                        std::vector<ContactType>& contacts) const {
    std::erase_if(contacts, [&](ContactType& c) {
      for (uint32_t* slot : {&c.key.body_a, &c.key.body_b}) {
        if ((*slot & particle_bit) == 0) continue;
        *slot = slot_of(names[*slot & ~particle_bit], systems);
        if (*slot == no_slot) return true;
      }
      return false;
    });
  }

 private:
  Result<std::shared_ptr<const Shape>> ball(double radius);

  uint32_t first_ = 0;                ///< slot of the first block
  std::vector<ParticleName> owners_;  ///< of the blocks
  std::vector<uint32_t> first_of_;
  std::map<double, std::shared_ptr<const Shape>> balls_;  ///< by radius
};

}  // namespace tumble
