#pragma once
#include "engine/dynamics/event/event_stepper.hpp"
#include "engine/dynamics/realtime/tick.hpp"
#include "engine/world/ledger/ledger.hpp"
#include "engine/world/ledger/realtime_books.hpp"
#include "engine/world/pressed_nets.hpp"
#include "engine/world/tick_forces.hpp"

#include <optional>
#include <vector>

namespace tumble {

struct WorldState;

/// Completes the tick of groups that are too expensive for the event stepper, by the stages of the
/// realtime tick, which step over all events of a sub-step at once. Contacts and friction are
/// implicit, as complementarity conditions between impulses and the velocities at the end of the
/// sub-step, and are solved by sweeps (projected Gauss-Seidel): a time-stepping scheme (Moreau
/// 1988, Stewart and Trinkle 1996; Acary and Brogliato 2008, chapter 10). Since it resolves no
/// order of events it always terminates, but their exact times are lost.
class WorldTimeStepping final : public TimeStepping {
 public:
  /// For one tick; the bodies are at its start, blocks of particles among them.
  WorldTimeStepping(WorldState& state, const TickForces& forces);

  Status advance(std::span<const uint32_t> bodies) override;
  /// Contacts of the bodies that were moved, in the form of the realtime stepper.
  std::span<const Contact> contacts() const { return std::as_const(contacts_).contacts(); }

 private:
  void start_again(std::span<const uint32_t> bodies);
  Status run();

  WorldState& state_;
  const TickForces& forces_;
  RealtimeSettings settings_;
  PairFilter apart_;
  std::vector<BodyLink> links_;
  ContactSet contacts_;
  PressedNets nets_;  ///< of the moved bodies: their springs are solved with the contacts
  RealtimeBooks books_;
  // State at the start of the tick, restored by each advance().
  std::optional<Ledger> ledger_;
  std::vector<Joint> joints_;
  std::vector<JointCoupling> couplings_;
  std::vector<Contact> known_;
};

}  // namespace tumble
