#pragma once
#include "engine/core/bytes.hpp"
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/joints/joint_coupling.hpp"
#include "engine/dynamics/joints/joint_loops.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Energies of the joints in the slots `which`.
JointEnergies energy_of_joints(std::span<const Joint> joints, std::span<const uint32_t> which,
                               std::span<const RigidBody> bodies);

void write_joint_def(ByteWriter& out, const JointDef& def);
JointDef read_joint_def(ByteReader& in);

/// The joints of a world, by slot; the pairs that they exclude and the links between bodies follow
/// from them.
class JointStore {
 public:
  HandlePool<JointTag> ids;
  std::vector<Joint> joints;   ///< what a step reads and writes; dead slots are undefined
  std::vector<JointDef> defs;  ///< likewise by slot
  /// Couplings between coordinates of live joints, in the order of slots and coordinates.
  std::vector<JointCoupling> couplings;
  /// Slots of live joints that every tick has to visit, ascending: a drive acts on them, full turns
  /// are counted, or they can break.
  std::vector<uint32_t> watched;
  /// Slots of live joints of which a motor's target follows a course, ascending.
  std::vector<uint32_t> timed;

  JointsAndCouplings all() const { return {joints, couplings}; }
  /// By slot and coordinate: mean force of its couplings along it over the last tick or sub-step
  /// [N], [N m]. Empty if there are no couplings.
  std::vector<std::array<double, most_coordinates>> coupling_forces() const;
  const JointDef* find(JointId id) const { return ids.contains(id) ? &defs[id.index] : nullptr; }
  /// Fills the slot of a live id. If the slot held a joint of the same kind between the same
  /// bodies, the new one keeps its full turns and, as long as one of the bodies can move, its
  /// forces: this is how motors get new targets.
  void put(JointId id, const JointDef& def, const BodySet& bodies);
  void release(JointId id);
  /// Energies of all joints at the present state of the bodies.
  JointEnergies energies(std::span<const RigidBody> bodies) const;
  /// Joints attached to a body, in the order of their slots.
  std::vector<JointId> at_body(BodyId body) const;
  /// Adds a link between the two bodies of every joint, in the order of slots; then links without a
  /// joint, which join the bodies of the two joints of each coupling.
  void add_links(std::vector<BodyLink>& links) const;
  /// The loops among the live joints, found anew when joints or their bodies have changed.
  std::vector<JointLoops>& loops(std::span<const RigidBody> bodies);
  /// Adds the pairs that do not collide because a joint excludes them or because they are of one
  /// group.
  void find_apart(std::span<const RigidBody> bodies, PairFilter& out) const;

  void save(ByteWriter& out) const;
  /// Fails on bytes that are not joints between bodies of this set.
  void load(ByteReader& in, const BodySet& bodies);

 private:
  void couple();
  void add_coupling(uint32_t slot, uint32_t x, const CoordinateCouple& couple,
                    std::span<const JointCoupling> before);

  std::optional<std::vector<JointLoops>> loops_;
  std::vector<uint32_t> followers_;  ///< slots of live joints with a CoordinateCouple, ascending
};

/// Joint ids given out, those of queued commands included, with the bodies of each joint: when a
/// command destroys a body, the ids of its joints must be released at once, before any command is
/// applied.
class ReservedJoints {
 public:
  bool contains(JointId id) const { return ids_.contains(id); }
  JointKind kind(JointId id) const { return ends_[id.index].kind; }
  JointId allocate(const JointDef& def);
  void change(JointId id, const JointDef& def);
  bool release(JointId id) { return ids_.release(id); }
  /// Releases the joints of a body in the order of their slots, as JointStore::at_body will list
  /// them.
  void release_at(BodyId body);

  void save(ByteWriter& out) const;
  void load(ByteReader& in);

 private:
  struct Ends {
    BodyId a, b;
    JointKind kind = JointKind::spherical;
  };
  HandlePool<JointTag> ids_;
  std::vector<Ends> ends_;  ///< by slot
};

}  // namespace tumble
