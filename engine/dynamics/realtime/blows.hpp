#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

namespace tumble {

// What blows need beyond the passes of a sub-step, of contacts with restitution and of limits of
// joints that bounce. A blow goes through the whole mechanism, is no guess for the next sub-step,
// and gives back no more energy than was taken.

// Limits.

/// Whether a limit that bounces may be met: the moving pass is solved without such limits first.
bool nears_limit(const SolverIsland& island);
/// These limits take part from here on.
void put_limits(const SolverIsland& island, double hs);
/// The greatest change of a blow on a limit since this was asked last, as a share of it; 0 when
/// none bounces.
double blow_change(const SolverIsland& island);

// Impulses of a sub-step in which there was a blow say nothing of the next one, which would give
// it again: that one starts from those before.

/// Whether a limit gave back a blow in the last relaxing pass; then impulses were remembered before
/// the limit was met.
bool limit_bounces(const SolverIsland& island);
void remember_impulses(const SolverIsland& island);
void recall_impulses(const SolverIsland& island);

// Energy. Of impulses P_i that act at once and change speeds along them from u_i to w_i each takes
// -P_i (u_i + w_i) / 2 of it. Beside joints a blow gives back no more than the contacts that
// bounce, and the joints that these shook, have taken in the tick: the approach was measured before
// it, and in a mechanism a point may be slower when it comes to touch.

/// Whether a contact bounces.
bool bounces(const SolverIsland& island);
/// Before a pass whose impulses are those of its points beyond `share` of what they have now, and
/// before a blow.
void note_speeds(const SolverIsland& island, double share);
/// What the impulses since then took [J].
double taken_by_contacts(const SolverIsland& island);
/// As note_speeds and taken_by_contacts, of joints: of kept rows what the other rows of an island
/// leave to them, of coordinates what holds them (DriveRow::taken).
void note_joint_speeds(const SolverIsland& island);
double taken_by_joints(const SolverIsland& island, JointPass pass);

/// Before contacts bounce, besides note_speeds and note_joint_speeds.
void remember_velocities(const SolverIsland& island);
void remember_relaxing(const SolverIsland& island);
/// What a blow since then gave, by contacts and joints, armatures included: its share s gives s
/// linear + s^2 square.
struct BlowEnergy {
  double linear = 0, square = 0;  ///< [J]
  /// The share of the blow that may stay where `taken` was taken [J].
  double bearable_share(double taken) const;
};
BlowEnergy blow_energy(const SolverIsland& island);
/// Leaves this share of the blow to velocities, and to contacts and joints.
void scale_velocities(const SolverIsland& island, double share);
void scale_impulses(const SolverIsland& island, double share);

}  // namespace tumble
