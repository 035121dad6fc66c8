#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/rigid/islands.hpp"
#include "engine/dynamics/rigid/particle_blocks.hpp"
#include "engine/world/ledger/force_shares.hpp"
#include "engine/world/ledger/ledger.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Books one tick of the realtime stepper. Over a part of a tick every force and impulse J does the
/// work J (v- + v+)/2 with the velocities of its beginning and its end, which add up to the change
/// of the kinetic energy; contacts in the lever arms of its beginning. What the positions of
/// pressed contacts move beyond the mean velocity is a correction, and its work against the
/// potentials is booked under `projection`.
class RealtimeBooks {
 public:
  std::vector<ForceShare> shares;  ///< of the tick, by force slot

  /// Before the velocities of a part change; islands are those of the part.
  void begin_part(std::span<const RigidBody> bodies);
  /// After the solver.
  void end_part(std::span<const RigidBody> bodies, const ContactSet& contacts,
                const IslandSet& islands, const std::vector<std::optional<ForceDef>>& forces,
                const Vec3& gravity, double h, Ledger& ledger);
  /// After a stage that only corrects what the solver did, or stops bodies; everything that it
  /// changed since end_part, or the last call, is booked under the line.
  void corrected(std::span<const RigidBody> bodies, LedgerLine line, Ledger& ledger);
  /// Before particles are integrated; those that are blocks are bodies.
  void particles(std::span<const ParticleSystem> systems,
                 const std::vector<std::optional<ForceDef>>& forces, const Vec3& gravity, double h,
                 const ParticleBlocks& blocks, Ledger& ledger) const;

 private:
  struct Motion {
    Pose pose;
    Vec3 v, omega;
  };
  /// Velocities and places that stand for a part of a tick.
  struct Mean {
    Vec3 x, v, omega;
    bool moved = false;  ///< solved in this part
  };
  void find_means(std::span<const RigidBody> bodies, const ContactSet& contacts,
                  const IslandSet& islands, double h);
  void book_contact(const Contact& contact, std::span<const RigidBody> bodies,
                    Ledger& ledger) const;
  LedgerEntry push(std::span<const RigidBody> bodies, uint32_t slot, const Vec3& impulse,
                   const Vec3& r) const;

  std::vector<Motion> start_, last_;
  std::vector<Mean> mean_;
  std::vector<Vec3> shifted_;  ///< what positions were corrected by in the part [m]
  std::vector<Vec3> held_;     ///< by slot: forces that have a potential [N]
};

}  // namespace tumble
