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

/// How groups in which events crowd finish a tick of the event stepper: by the stages of the
/// realtime tick, which step over all events of a sub-step at once. Contacts and friction are
/// implicit, as inequalities between impulses and the velocities at the end of the sub-step, and
/// are solved by sweeps: a time-stepping scheme of complementarity kind (Moreau 1988, Stewart and
/// Trinkle 1996; Acary and Brogliato 2008, chapter 10). It needs no order of events, which is why
/// it always ends, and gives up their exact times.
class WorldTimeStepping final : public TimeStepping {
 public:
  /// For one tick, at whose start the bodies are; blocks of particles are among them.
  WorldTimeStepping(WorldState& state, const TickForces& forces);

  Status advance(std::span<const uint32_t> bodies) override;
  /// Of the bodies that were moved, in the form in which worlds keep contacts.
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
  PressedNets nets_;  ///< of what is moved: their springs are solved with its contacts
  RealtimeBooks books_;
  // As they were at the start of the tick, for each advance().
  std::optional<Ledger> ledger_;
  std::vector<Joint> joints_;
  std::vector<JointCoupling> couplings_;
  std::vector<Contact> known_;
};

}  // namespace tumble
