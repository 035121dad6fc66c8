#pragma once
#include "engine/core/bytes.hpp"
#include "engine/dynamics/bodies/pair_filter.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/joints/joint_coupling.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Of these of the joints, by slot.
JointEnergies energy_of_joints(std::span<const Joint> joints, std::span<const uint32_t> which,
                               std::span<const RigidBody> bodies);

void write_joint_def(ByteWriter& out, const JointDef& def);
JointDef read_joint_def(ByteReader& in);

/// The joints of a world, by slot. What they exclude and whom they tie follows from them.
class JointStore {
 public:
  HandlePool<JointTag> ids;
  std::vector<Joint> joints;   ///< what a step reads and writes; dead slots mean nothing
  std::vector<JointDef> defs;  ///< likewise by slot
  /// What couples the coordinates of live joints, in the order of their slots and coordinates.
  std::vector<JointCoupling> couplings;
  /// Slots of live joints that need a look in every tick, ascending: something acts along them,
  /// full turns are counted, or they can break.
  std::vector<uint32_t> watched;
  /// Likewise those of which a motor's target follows a course.
  std::vector<uint32_t> timed;

  JointsAndCouplings all() const { return {joints, couplings}; }
  /// Force of its couplings along a coordinate, in the mean of the last tick or sub-step.
  double coupling_force(uint32_t joint, size_t coordinate) const;
  const JointDef* find(JointId id) const { return ids.contains(id) ? &defs[id.index] : nullptr; }
  /// Fills the slot of a live id. Where a joint of the same kind between the same bodies was there,
  /// the new one goes on with its forces and turns: motors get new targets so.
  void put(JointId id, const JointDef& def, const BodySet& bodies);
  void release(JointId id);
  /// Of all joints, at the bodies' present state.
  JointEnergies energies(std::span<const RigidBody> bodies) const;
  /// Joints that end at a body, in the order of their slots.
  std::vector<JointId> at_body(BodyId body) const;
  /// One link for every joint, in the order of their slots; then, of no joint, those that keep the
  /// bodies of both joints of a coupling together.
  void add_links(std::vector<BodyLink>& links) const;
  /// Bodies that do not collide since a joint ties them, or they are of one group.
  void find_apart(std::span<const RigidBody> bodies, PairFilter& out) const;

  void save(ByteWriter& out) const;
  /// Fails on bytes that are no joints between the given bodies.
  void load(ByteReader& in, const BodySet& bodies);

 private:
  void couple();
  void add_coupling(uint32_t slot, uint32_t x, const CoordinateCouple& couple,
                    std::span<const JointCoupling> before);

  std::vector<uint32_t> followers_;  ///< slots of live joints with a CoordinateCouple, ascending
};

/// Joint ids given out, those of waiting commands included, with the bodies that they tie: whoever
/// destroys a body must know which joints go with it before any command is applied.
class ReservedJoints {
 public:
  bool contains(JointId id) const { return ids_.contains(id); }
  JointKind kind(JointId id) const { return ends_[id.index].kind; }
  JointId allocate(const JointDef& def);
  void change(JointId id, const JointDef& def);
  bool release(JointId id) { return ids_.release(id); }
  /// In the order of their slots, as JointStore::at_body gives them later.
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
