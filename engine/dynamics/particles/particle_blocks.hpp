#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace tumble {

/// Particles among the bodies: blocks of three degrees of freedom, each a ball of the particle's
/// radius that has mass but no inertia, and so never turns. They follow the bodies for as long as a
/// tick lasts; outside ticks there are none.
///
/// Under the event stepper what touches a particle feels it at its centre, as if the other's
/// surface were farther out by the radius: what a particle and a body do to each other then changes
/// no angular momentum. Friction between two particles does, since neither can turn.
class ParticleBlocks {
 public:
  static constexpr uint32_t no_slot = ~uint32_t{0};
  enum class Which : uint8_t {
    not_fast,
    colliding
  };  ///< colliding ones are neither fast nor grains

  /// Whether a system has blocks among these.
  static bool has_blocks(Which which, const ParticleSystem& system);
  /// Appends the particles of systems, with the forces on them; systems that do not collide have no
  /// shapes.
  Status append(Which which, const HandlePool<ParticleSystemTag>& ids,
                std::span<const ParticleSystem> systems, std::vector<RigidBody>& bodies);
  /// Gives the systems the motion of their blocks, which took h seconds, and clears their forces.
  void give_back(std::span<const RigidBody> bodies, double h,
                 std::span<ParticleSystem> systems) const;
  /// Removes the blocks.
  void remove(std::vector<RigidBody>& bodies);

  /// By system slot that of its first particle, no_slot for systems that have no blocks.
  std::span<const uint32_t> first_slots() const { return first_of_; }
  bool has_blocks(size_t system) const {
    return system < first_of_.size() && first_of_[system] != no_slot;
  }
  bool empty() const { return owners_.empty(); }
  bool holds(uint32_t slot) const { return slot >= first_ && slot - first_ < owners_.size(); }
  ParticleName name(uint32_t slot) const { return owners_[slot - first_]; }
  /// no_slot of what is gone, or has no block.
  uint32_t slot_of(const ParticleName& name, std::span<const ParticleSystem> systems) const;

  /// Slots of blocks are those of one tick: between ticks contacts name particles by their place
  /// in a list, with particle_bit.
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
  /// The reverse; contacts of particles that are gone, or have no blocks, are dropped.
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
