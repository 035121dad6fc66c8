#pragma once
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"
#include "engine/math/lcp/report.hpp"

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace tumble {

/// One point of a collision of several bodies, or a joint limit that is reached.
struct ImpactPoint {
  uint32_t a = no_block, b = no_block;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< from the centres of mass, world axes [m]
  Vec3 normal = Vec3::UnitY();                      ///< unit, from A to B
  double friction = 0;                              ///< Coulomb coefficient [-]
  double restitution = 0;                           ///< 0..1 [-]
  /// Relative velocity of B at which there is no slip (belts), world axes [m/s]; its normal
  /// component is ignored.
  Vec3 surface_velocity = Vec3::Zero();
  /// For a joint limit, in place of a point and its normal: the row whose velocity leads away from
  /// the limit. It has no friction; its impulse and velocities are the x components of vectors.
  std::optional<Row> along;
};

enum class ImpactStatus {
  solved,
  unsolved,  ///< a complementarity problem has no acceptable solution: velocities are as before
  invalid,   ///< a value is not finite
};

struct ImpactReport {
  ImpactStatus status = ImpactStatus::solved;
  int rounds = 0;  ///< number of single collisions, or of complementarity problems solved
  std::vector<Vec3> impulses;          ///< by point, on B, world axes [N s]
  std::vector<double> joint_impulses;  ///< by row of the joints [N s] or [N m s]
  std::vector<Vec3> velocity_before;   ///< by point, of B relative to A, less belts [m/s]
  std::vector<Vec3> velocity_after;
  /// Work of all impulses over the relative motion [J]: energy lost in collisions, at most rounding
  /// error above zero.
  double work = 0;
  /// Share of the restitution that was applied; below 1 where all of it would have created energy.
  double restitution_scale = 1;
  double residual = 0;      ///< greatest residual of the problems solved [-]
  std::string_view solver;  ///< solver of the last problem; empty when there was none
  std::vector<lcp::ConeAttempt> attempts;  ///< stages of the last problem
};

/// Finds the impulses of one or many simultaneous collisions, and changes the velocities of the
/// blocks so that no point approaches any more. The kinetic energy, relative to prescribed motion
/// of kinematic bodies and belts, never grows. Joints transmit impulses (Coutinho 2013 §5.6.1);
/// they must be up to date and satisfied, and are so afterwards.
using ImpactLaw = ImpactReport (*)(std::span<DofBlock> blocks, std::span<const ImpactPoint> points,
                                   const Articulation& joints);

struct ImpactLawEntry {
  std::string_view name;
  std::string_view text;  ///< one line of description
  ImpactLaw resolve;
};

/// "reflections" (the default), "sequential", "simultaneous_newton", "simultaneous_poisson".
const std::vector<ImpactLawEntry>& all_impact_laws();

}  // namespace tumble
