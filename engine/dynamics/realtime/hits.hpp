#pragma once
#include "engine/dynamics/realtime/solver_rows.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

// Hits on mechanisms: contacts in islands with joints that close faster than forces explain. The
// sweeps of a sub-step would meet the link that is hit and not what hangs on it, and as the warm
// start of the next sub-step the impulse of a hit would be repeated. A hit is therefore an impact
// by itself, before and apart from the impulses of the passes: one problem of all contact points
// that press or close, in which joints, couplings and armatures transmit what the points do
// (Coutinho 2013 §5.6). Hard limits without restitution, motors that hold a rate and dry friction
// take part like contacts; position motors, springs and other limits do not.

/// Points that are hit in a sub-step (indices into the island's points).
using HitPoints = std::vector<uint32_t>;

/// To be called when forces have acted on the velocities, and joints have not, for what joints
/// press together is no hit: leaves the speeds with which the bodies just touch at the end of the
/// sub-step. Returns the energy that contacts with restitution, limits, motors that hold their rate
/// and friction took [J].
double hit_before_motion(const SolverContext& context, const SolverIsland& island, double hs,
                         HitPoints& points);
/// To be called before the relaxing pass: takes the rest of the speed of these points, as far as
/// they would close in the next sub-step. Returns the same energy.
double hit_after_motion(const SolverIsland& island, double hs, const HitPoints& points);

}  // namespace tumble
