#pragma once
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/joints/joint_push.hpp"
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
/// potentials is booked under `projection`; that of jointed bodies that nothing presses under
/// `joints`.
class RealtimeBooks {
 public:
  std::vector<ForceShare> shares;  ///< of the tick, by force slot
  /// By index, and what the solver had them do in the part; set before end_part().
  struct Joints {
    std::span<const Joint> joints;
    std::span<const JointPush> pushes;
  } joints;

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
  void add_memory(MemoryUse& use) const {
    use.bodies += heap_bytes(start_, last_, axes_, mean_, shifted_, held_);
  }

 private:
  struct Motion {
    Pose pose;
    Vec3 v, omega;
  };
  /// Velocities and places that stand for a part of a tick.
  struct Mean {
    Vec3 x, v, omega;
    bool moved = false;    ///< solved in this part
    bool jointed = false;  ///< a joint holds it and no contact
  };
  void find_means(std::span<const RigidBody> bodies, const ContactSet& contacts,
                  const IslandSet& islands, double h);
  void find_shifts(std::span<const RigidBody> bodies, const ContactSet& contacts,
                   const IslandSet& islands, double h);
  void book_joints(std::span<const RigidBody> bodies, const IslandSet& islands,
                   Ledger& ledger) const;
  /// What a contact did to its two bodies: an impulse on B, minus it on A, and its moments about
  /// either centre (both with the sign of the impulse on B).
  struct Push {
    Vec3 impulse = Vec3::Zero(), moment_a = Vec3::Zero(), moment_b = Vec3::Zero();
  };
  struct ContactLines {
    LedgerEntry normal, friction, kinematic;
  };
  void book_contacts(std::span<const RigidBody> bodies, const ContactSet& contacts,
                     const IslandSet& islands, Ledger& ledger) const;
  void book_contact(const Contact& contact, std::span<const RigidBody> bodies,
                    ContactLines& lines) const;
  void book_push(const Contact& contact, const Push& push_of, const Vec3& belt,
                 std::span<const RigidBody> bodies, LedgerEntry& line,
                 LedgerEntry& kinematic) const;
  /// An impulse with a moment about the centre, on a body.
  LedgerEntry push(std::span<const RigidBody> bodies, uint32_t slot, const Vec3& impulse,
                   const Vec3& moment) const;

  std::vector<Motion> start_, last_;
  std::vector<Mat3> axes_;  ///< orientations at the start
  std::vector<Mean> mean_;
  std::vector<Vec3> shifted_;  ///< what positions were corrected by in the part [m]
  std::vector<Vec3> held_;     ///< by slot: forces that have a potential [N]
};

}  // namespace tumble
