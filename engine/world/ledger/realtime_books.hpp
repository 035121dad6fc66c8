#pragma once
#include "engine/core/crew.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/joints/joint_push.hpp"
#include "engine/dynamics/particles/particle_blocks.hpp"
#include "engine/world/ledger/force_shares.hpp"
#include "engine/world/ledger/ledger.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {
class ContinuousStage;

/// Books an entry on the line of a force, or on the user's if the force is the mouse.
void book_share(Ledger& ledger, const std::optional<ForceDef>& def, uint32_t slot,
                const LedgerEntry& e);

/// Books one tick of the realtime stepper. Over a part of a tick every force or impulse J does the
/// work J (v- + v+)/2, with the velocities at the start and the end of the part, so that the sum is
/// the change of the kinetic energy; contacts have the lever arms of the start. Displacements
/// beyond the mean velocity are corrections: their work against the potentials is booked under
/// `projection` for bodies pressed by contacts, under `joints` for bodies that only joints hold.
class RealtimeBooks {
 public:
  std::vector<ForceShare> shares;  ///< of the tick, by force slot; that of fluids follows them
  /// The joints by slot, with their impulses in the part. `joints` and `energy` are set before
  /// begin_part(), `pushes` and the new `energy` before end_part().
  struct Joints {
    std::span<const Joint> joints;
    std::span<const JointPush> pushes;
    double energy = 0;  ///< of springs, compliant limits and armatures now [J]
  } joints;

  /// What the books of a part of a tick read.
  struct Part {
    std::span<const RigidBody> bodies;
    const ContactSet& contacts;
    const IslandSet& islands;  ///< of the part
    const std::vector<std::optional<ForceDef>>& forces;
    Vec3 gravity;
    double h = 0;  ///< [s]
  };

  /// Before the velocities of a part change; until the next part begins only the `involved` bodies
  /// may change. Sums are over fixed chunks in their order, so that they do not depend on the
  /// number of threads of the crew.
  void begin_part(std::span<const RigidBody> bodies, std::span<const uint32_t> involved,
                  Crew& crew);
  /// After the solver.
  void end_part(const Part& part, Ledger& ledger, Crew& crew);
  /// After a stage that corrects the solver's result or stops bodies: all changes since end_part(),
  /// or since the last call, are booked on this line.
  void corrected(std::span<const RigidBody> bodies, LedgerLine line, Ledger& ledger, Crew& crew);
  /// Books what the continuous stage changed: of bodies that kinematic ones carried along as work
  /// of these, of the others as projection.
  void put_back(std::span<const RigidBody> bodies, const ContinuousStage& stage,
                const Vec3& gravity, Ledger& ledger, Crew& crew);
  /// Before particles are integrated; particles that are blocks are booked as bodies.
  void particles(std::span<const ParticleSystem> systems,
                 const std::vector<std::optional<ForceDef>>& forces, const Vec3& gravity, double h,
                 const ParticleBlocks& blocks, Ledger& ledger) const;
  void add_memory(MemoryUse& use) const {
    use.bodies += heap_bytes(involved_, last_, mean_, shifted_, held_, touch_);
  }

 private:
  /// Books the change of these bodies since they were last booked.
  void corrected(std::span<const RigidBody> bodies, std::span<const uint32_t> slots,
                 LedgerLine line, Ledger& ledger, Crew& crew);
  struct Motion {
    Pose pose;
    Vec3 v, omega;
  };
  /// State of a body for a part of a tick: all that the booking of contacts reads, in one place,
  /// since a RigidBody is large.
  struct Mean {
    Vec3 x, v, omega;
    Mat3 axes;  ///< orientation at the start
    double mass = 0;
    bool dynamic = false;
    bool moved = false;  ///< solved in this part
  };
  /// What held a body in the part, for the booking of its displacement.
  enum class Touch : uint8_t { nothing, contact, joint_only };
  /// Effect of a cause on two bodies: an impulse on B, its reverse on A, and its moments about the
  /// two centres, both with the sign of the impulse on B.
  struct Push {
    Vec3 impulse = Vec3::Zero(), moment_a = Vec3::Zero(), moment_b = Vec3::Zero();
  };
  struct ContactLines {
    LedgerEntry normal, friction, kinematic;
  };
  Mean mean_of(const Part& part, uint32_t slot, const Motion& start) const;
  void book_weights(const Part& part, Ledger& ledger, Crew& crew);
  void book_shares(const Part& part, Ledger& ledger);
  void book_contacts(const Part& part, Ledger& ledger, Crew& crew);
  void book_contact(const Contact& contact, ContactLines& lines) const;
  void book_push(const Contact& contact, const Push& push_of, const Vec3& belt, LedgerEntry& line,
                 LedgerEntry& kinematic) const;
  void book_joints(const Part& part, Ledger& ledger);
  void book_shifts(Ledger& ledger, Crew& crew) const;
  /// Entry of an impulse on a body, with its moment about the centre.
  LedgerEntry push(uint32_t slot, const Vec3& impulse, const Vec3& moment) const;

  std::vector<uint32_t> involved_;
  // The following are by body slot, and valid for the involved bodies.
  std::vector<Motion> last_;  ///< at the start of the part; then at the last booking
  std::vector<Mean> mean_;
  std::vector<Vec3> shifted_;  ///< displacements in the part beyond those of the mean velocity [m]
  std::vector<Vec3> held_;     ///< conservative forces [N]
  std::vector<Touch> touch_;
  /// Of springs, compliant limits and armatures at the start of the part [J].
  double joint_energy_ = 0;
};

}  // namespace tumble
