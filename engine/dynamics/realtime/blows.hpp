#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"
#include "engine/dynamics/realtime/solver_rows.hpp"

namespace tumble {

// Impacts ("blows") beyond the passes of a sub-step: at contacts with restitution and at joint
// limits that bounce. An impact spreads through the whole mechanism, is no warm start for the next
// sub-step, and gives back no more energy than was taken.

// Limits.

/// Whether a bouncing limit may be reached in this sub-step; then the moving pass is solved without
/// such limits first.
bool nears_limit(const SolverIsland& island);
/// Includes these limits in the force laws from here on.
void put_limits(const SolverIsland& island, double hs);
/// The greatest change of a limit's impulse of impact since the last call, as a share of that
/// impulse; 0 if none bounces.
double blow_change(const SolverIsland& island);

// The impulses of a sub-step with an impact would repeat it as the warm start of the next one,
// which therefore starts from the impulses before the impact.

/// Whether a limit bounced in the last relaxing pass; remember_impulses() was then called before
/// the limits took part.
bool limit_bounces(const SolverIsland& island);
void remember_impulses(const SolverIsland& island);
void recall_impulses(const SolverIsland& island);

// Energy. Of impulses P_i that act at once and change the speeds along them from u_i to w_i, each
// takes the energy -P_i (u_i + w_i) / 2. In islands with joints an impact gives back no more than
// was taken in the tick by the contacts that bounce, and by the joints that these shook: the
// approach was measured at the start of the tick, and in a mechanism a point may be slower by the
// time it touches.

/// Whether any contact bounces.
bool bounces(const SolverIsland& island);
/// Notes normal speeds, and `share` times the present normal impulses: the following pass, or an
/// impact, is credited with what its impulses exceed that.
void note_speeds(const SolverIsland& island, double share);
/// Energy that these impulses took since note_speeds() [J].
double taken_by_contacts(const SolverIsland& island);
/// The same for joints and couplings: of kept rows, with all of their impulses; of coordinates,
/// what their parts took (DriveRow::taken).
void note_joint_speeds(const SolverIsland& island);
double taken_by_joints(const SolverIsland& island, JointPass pass);

/// To be called before contacts bounce, besides note_speeds and note_joint_speeds.
void remember_velocities(const SolverIsland& island);
void remember_relaxing(const SolverIsland& island);
/// Energy that an impact gave since then to bodies and armatures, by contacts and joints: its share
/// s gives s linear + s^2 square.
struct BlowEnergy {
  double linear = 0, square = 0;  ///< [J]
  /// The greatest share of the impact that gives back no more than `taken` [J].
  double bearable_share(double taken) const;
};
BlowEnergy blow_energy(const SolverIsland& island);
/// Reduces the impact to this share: of velocities, and of impulses of contacts and joints.
void scale_velocities(const SolverIsland& island, double share);
void scale_impulses(const SolverIsland& island, double share);

}  // namespace tumble
