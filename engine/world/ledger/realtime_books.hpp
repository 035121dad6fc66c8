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

/// Books on the line of a force, or the user's for the mouse.
void book_share(Ledger& ledger, const std::optional<ForceDef>& def, uint32_t slot,
                const LedgerEntry& e);

/// Books one tick of the realtime stepper. Over a part of a tick every force and impulse J does the
/// work J (v- + v+)/2 with the velocities of its beginning and its end, which add up to the change
/// of the kinetic energy; contacts in the lever arms of its beginning. What the positions of
/// pressed contacts move beyond the mean velocity is a correction, and its work against the
/// potentials is booked under `projection`; that of jointed bodies that nothing presses under
/// `joints`.
class RealtimeBooks {
 public:
  std::vector<ForceShare> shares;  ///< of the tick, by force slot; behind them that of fluids
  /// By index, and what the solver had them do in the part: joints are set before begin_part(),
  /// pushes and energy before end_part() too.
  struct Joints {
    std::span<const Joint> joints;
    std::span<const JointPush> pushes;
    double energy = 0;  ///< of springs, compliant limits and armatures now [J]
  } joints;

  /// What a part of a tick is booked from.
  struct Part {
    std::span<const RigidBody> bodies;
    const ContactSet& contacts;
    const IslandSet& islands;  ///< of the part
    const std::vector<std::optional<ForceDef>>& forces;
    Vec3 gravity;
    double h = 0;  ///< [s]
  };

  /// Before the velocities of a part change, which only those of the `involved` bodies may until
  /// the next part begins. Sums are those of fixed chunks in their order, however many threads the
  /// crew has.
  void begin_part(std::span<const RigidBody> bodies, std::span<const uint32_t> involved,
                  Crew& crew);
  /// After the solver.
  void end_part(const Part& part, Ledger& ledger, Crew& crew);
  /// After a stage that only corrects what the solver did, or stops bodies; everything that it
  /// changed since end_part, or the last call, is booked under the line.
  void corrected(std::span<const RigidBody> bodies, LedgerLine line, Ledger& ledger, Crew& crew);
  /// Before particles are integrated; those that are blocks are bodies.
  void particles(std::span<const ParticleSystem> systems,
                 const std::vector<std::optional<ForceDef>>& forces, const Vec3& gravity, double h,
                 const ParticleBlocks& blocks, Ledger& ledger) const;
  void add_memory(MemoryUse& use) const {
    use.bodies += heap_bytes(involved_, last_, mean_, shifted_, held_, touch_);
  }

 private:
  struct Motion {
    Pose pose;
    Vec3 v, omega;
  };
  /// A body as it stands for a part of a tick. Contacts ask for all of it and nothing else: bodies
  /// are large.
  struct Mean {
    Vec3 x, v, omega;
    Mat3 axes;  ///< orientation at the start
    double mass = 0;
    bool dynamic = false;
    bool moved = false;  ///< solved in this part
  };
  /// What held a body in the part.
  enum class Touch : uint8_t { nothing, contact, joint_only };
  /// What a cause did to two bodies: an impulse on B, minus it on A, and its moments about either
  /// centre (both with the sign of the impulse on B).
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
  /// An impulse with a moment about the centre, on a body.
  LedgerEntry push(uint32_t slot, const Vec3& impulse, const Vec3& moment) const;

  std::vector<uint32_t> involved_;
  // By slot, of the involved.
  std::vector<Motion> last_;  ///< when the part began; then what was booked last
  std::vector<Mean> mean_;
  std::vector<Vec3> shifted_;  ///< what positions moved in the part beyond the mean velocity [m]
  std::vector<Vec3> held_;     ///< forces that have a potential [N]
  std::vector<Touch> touch_;
  double joint_energy_ = 0;  ///< of springs, compliant limits and armatures, when it began [J]
};

}  // namespace tumble
