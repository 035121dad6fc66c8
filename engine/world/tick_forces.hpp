#pragma once
#include "engine/world/ledger/force_shares.hpp"
#include "engine/world/state.hpp"

namespace tumble {

/// The smooth forces at any moment of a tick, as the event stepper asks for them. Blocks of
/// particles count as bodies. Other particles move once a tick: the forces on them, and their
/// forces on bodies, are computed at the start of the tick and constant over it.
class TickForces final : public ForceRates {
 public:
  /// Computes the forces on all particles. Before this the blocks must be appended, and the shares
  /// of forces attached to particles without blocks must be in the realtime books. Without
  /// `drives`, forces along coordinates of joints are left out.
  explicit TickForces(WorldState& state, bool drives = true);

  /// Sets force and torque of the given bodies at t seconds after the start of the tick. May be
  /// called concurrently for groups of bodies that no spring connects.
  void operator()(double t, std::span<const uint32_t> bodies) const;

  /// The force of each slot on the bodies at their present poses, as the realtime stepper applies
  /// forces: constant over the tick, springs implicitly. Afterwards the force sums of the bodies
  /// are the sum of these, without gravity.
  void share(std::span<const uint32_t> bodies, std::vector<ForceShare>& out) const;

  /// Cause 0 is gravity, i + 1 the force in slot i; then follow fluids, springs of joints, and
  /// motors of joints.
  std::vector<uint32_t> causes(std::span<const uint32_t> bodies) const override;
  void rates(double t, std::span<const uint32_t> bodies, std::span<const uint32_t> causes,
             std::span<CauseEffect> out) const override;

 private:
  void assign_anchored(uint32_t force);
  void hold(uint32_t force);
  void hold_fluids();
  void assign_drives();
  CauseEffect drive_effect(bool motors, double t, std::span<const uint32_t> bodies) const;
  void share_alone(uint32_t force, std::span<const uint32_t> bodies, ForceContext& context,
                   ForceShare& share) const;
  void clear_sums(std::span<const uint32_t> bodies) const;
  CauseEffect effect(uint32_t force, ForceContext& context, std::span<const uint32_t> bodies) const;
  uint32_t springs_of_joints() const { return uint32_t(state_.forces.size()) + 1; }
  uint32_t motors_of_joints() const { return springs_of_joints() + 1; }
  struct Held {
    uint32_t force, slot;
    Vec3 push, turn;                  ///< [N], [N m]
    Vec3 elastic_push, elastic_turn;  ///< the parts that have a potential
  };

  WorldState& state_;
  /// Slots of forces without anchors, which act on everything.
  std::vector<uint32_t> fields_;
  std::vector<std::vector<uint32_t>> anchored_;  ///< by body slot: forces evaluated with this body
  std::vector<std::vector<uint32_t>> driven_;    ///< by body slot: joints evaluated with this body
  std::vector<Held> holds_;                      ///< constant forces on bodies, by force
  /// By slot: sums of the constant forces and torques.
  std::vector<std::pair<Vec3, Vec3>> held_;
};

}  // namespace tumble
