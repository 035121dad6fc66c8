#pragma once
#include "engine/world/ledger/force_shares.hpp"
#include "engine/world/state.hpp"

namespace tumble {

/// The smooth forces of one tick at any moment of it, as the event stepper asks for them; bodies
/// are also the blocks of particles behind them. Particles that have none move once a tick: their
/// forces, and what they do to bodies, are found at its start and stay.
class TickForces final : public ForceRates {
 public:
  /// Sets the forces on all particles; the blocks must be there, and the shares of forces that hold
  /// particles without blocks.
  /// Without `drives` what acts along coordinates of joints is left out.
  explicit TickForces(WorldState& state, bool drives = true);

  /// Sets force and torque of the given bodies at t seconds after the start of the tick. Groups of
  /// bodies that no spring ties to each other may be asked for at the same time.
  void operator()(double t, std::span<const uint32_t> bodies) const;

  /// What each force does to the bodies, by its slot, where they are now and as the realtime
  /// stepper applies forces: once for the tick, with a look ahead. Their force sums are that sum
  /// afterwards, without gravity.
  void share(std::span<const uint32_t> bodies, std::vector<ForceShare>& out) const;

  /// Cause 0 is gravity, i + 1 the force in slot i, then those of fluids, of springs of joints, and
  /// of their motors.
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
    Vec3 elastic_push, elastic_turn;  ///< of them what a potential explains
  };

  WorldState& state_;
  std::vector<uint32_t> fields_;                 ///< slots of forces on everything
  std::vector<std::vector<uint32_t>> anchored_;  ///< by body slot: forces that it answers for
  std::vector<std::vector<uint32_t>> driven_;    ///< by body slot: joints that it answers for
  std::vector<Held> holds_;                      ///< by force
  std::vector<std::pair<Vec3, Vec3>> held_;      ///< by slot: force and torque by such particles
};

}  // namespace tumble
