#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"
#include "engine/math/lcp/report.hpp"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace tumble {

/// One point of a collision of several bodies, or a limit of a joint that is reached.
struct ImpactPoint {
  uint32_t a = no_block, b = no_block;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< from the centres of mass, world axes [m]
  Vec3 normal = Vec3::UnitY();                      ///< unit, from A to B
  double friction = 0;                              ///< Coulomb coefficient [-]
  double restitution = 0;                           ///< 0..1 [-]
  /// Relative velocity of B at which there is no slip (belts), world axes; what of it is along the
  /// normal counts for nothing [m/s].
  Vec3 surface_velocity = Vec3::Zero();
  /// Of a limit: the row whose velocity leads away from it, in the place of a point and its normal.
  /// It has no friction; impulse and velocities are the x of vectors.
  std::optional<Row> along;
};

enum class ImpactStatus {
  solved,
  unsolved,  ///< a complementarity problem had no believable answer: velocities are as before
  invalid,   ///< a value is not finite
};

struct ImpactReport {
  ImpactStatus status = ImpactStatus::solved;
  int rounds = 0;                      ///< single collisions, or complementarity problems solved
  std::vector<Vec3> impulses;          ///< by point, on B, world axes [N s]
  std::vector<double> joint_impulses;  ///< by row of the joints [N s] or [N m s]
  std::vector<Vec3> velocity_before;   ///< by point, slip and approach of B [m/s]
  std::vector<Vec3> velocity_after;
  /// Work of all impulses over the relative motion [J]: what collisions took, never more than
  /// rounding above zero.
  double work = 0;
  double restitution_scale = 1;  ///< below 1: the share of restitution that did not create energy
  double residual = 0;           ///< greatest of the problems solved [-]
  std::string_view solver;       ///< that answered the last of them; empty when there was none
  std::vector<lcp::ConeAttempt> attempts;  ///< at the last of them
};

/// How the impulses of one or many simultaneous collisions are found. Changes the velocities of the
/// blocks so that no point approaches any more. The kinetic energy, seen from whatever kinematic
/// bodies and belts prescribe, never grows. Joints pass impulses on (Coutinho 2013 §5.6.1); they
/// must be up to date, and hold before and after.
using ImpactLaw = ImpactReport (*)(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                   const Articulation& joints);

struct ImpactLawEntry {
  std::string_view name;
  std::string_view text;  ///< a line for people
  ImpactLaw resolve;
};

/// "reflections" (the default), "sequential", "simultaneous_newton", "simultaneous_poisson".
const std::vector<ImpactLawEntry>& all_impact_laws();

}  // namespace tumble
