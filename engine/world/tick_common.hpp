#pragma once
#include "engine/world/state.hpp"

namespace tumble {

class TickListener;
struct RealtimeTick;
struct TickReport;

/// What ties bodies together besides contacts: springs, then joints. Until the next call.
const std::vector<BodyLink>& body_links(WorldState& state);
/// The same with springs on particles that are blocks now.
std::vector<BodyLink> block_links(WorldState& state);

/// "body 'NAME' (slot N)"; particles that are blocks have a name too.
std::string body_label(const WorldState& state, uint32_t slot);

/// What differs between the ticks of a world that the realtime stages take.
struct TickChoice {
  const RealtimeSettings& settings;
  std::span<const BodyLink> links;
  const PairFilter& apart;
  ContactSet& contacts;
  TickListener& listener;
};
/// A tick by the realtime stages.
RealtimeTick realtime_tick(WorldState& state, const TickChoice& choice);

/// What a tick gives in the end: when somebody asked it to stop, that, whatever it had found by
/// then. An error says in which tick.
Status outcome_of_tick(const WorldState& state, Status status);

/// What the stages of a RealtimeTick gave, with the body or particle that is to blame.
Status outcome_of_stages(const WorldState& state, const TickReport& report, const Status& done);

/// Names the first body or particle whose state is not finite.
Status check_finite(const WorldState& state);

/// The stage that moves particles that are no blocks by the forces on them.
void integrate_particles(WorldState& state);

/// The last that happens to particles in a tick: those that left their periodic box come in on the
/// other side, and what they are coloured by is noted.
void finish_particles(WorldState& state);

/// Contacts of particles over the tick that has just been computed.
Status detect_particle_contacts(WorldState& state, const TickBackup& start);

}  // namespace tumble
