#pragma once
#include "engine/world/state.hpp"

namespace tumble {

class TickListener;
struct RealtimeTick;
struct TickReport;

/// Links between bodies other than contacts: springs, then joints. Valid until the next call.
const std::vector<BodyLink>& body_links(WorldState& state);
/// Likewise, with the springs on particles that are blocks now.
std::vector<BodyLink> block_links(WorldState& state);

/// "body 'NAME' (slot N)"; blocks are named by their particle.
std::string body_label(const WorldState& state, uint32_t slot);

/// The inputs of the realtime stages that differ between the ticks of a world.
struct TickChoice {
  const RealtimeSettings& settings;
  std::span<const BodyLink> links;
  const PairFilter& apart;
  ContactSet& contacts;
  TickListener& listener;
  std::span<const CourseMotion> courses = {};  ///< see RealtimeTick
};
/// The context in which the realtime stages compute a tick.
RealtimeTick realtime_tick(WorldState& state, const TickChoice& choice);

/// Final status of a tick: `cancelled` if a stop was requested, whatever else was found; an error
/// is given its tick.
Status outcome_of_tick(const WorldState& state, Status status);

/// Status of the stages of a RealtimeTick; an error names the body or particle that caused it.
Status outcome_of_stages(const WorldState& state, const TickReport& report, const Status& done);

/// Error that names the first body or particle whose state is not finite.
Status check_finite(const WorldState& state);

/// The stage that moves particles that are not blocks by the forces on them.
void integrate_particles(WorldState& state);

/// The last stage of particles in a tick: those that left their periodic box enter on the opposite
/// side, and the range of the values for their colours is updated.
void finish_particles(WorldState& state);

/// Finds contacts of particles during the tick that has just been computed.
Status detect_particle_contacts(WorldState& state, const TickBackup& start);

}  // namespace tumble
