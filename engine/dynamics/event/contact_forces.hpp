#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/contact/surface/element_gap.hpp"
#include "engine/dynamics/joints/articulation.hpp"
#include "engine/dynamics/rows/rows.hpp"
#include "engine/math/lcp/solvers.hpp"

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace tumble {

/// A closed contact for which a force is sought.
struct ForcePoint {
  uint32_t a = no_block, b = no_block;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< from the centres of mass, world axes [m]
  Vec3 normal = Vec3::UnitY();                      ///< unit, from A to B
  double bias = 0;                                  ///< ElementGap::bias [m/s2]
  Vec3 tangential_bias = Vec3::Zero();              ///< ElementGap::tangential_bias [m/s2]
  double friction = 0;                              ///< [-]
  bool sliding = false;
  Vec3 slip = Vec3::Zero();  ///< unit, along the slip, when sliding; world axes
};

/// A row along which a force within bounds is sought: what acts along a coordinate of a joint.
struct BoundedRow {
  Row row;
  /// Added to J a, it is what the force is to hold at zero [m/s2] or [rad/s2]: at the lower bound
  /// the sum may be positive, at the upper one negative.
  double bias = 0;
  double least = 0, most = 0;  ///< bounds of the force [N] or [N m]
  double force = 0;            ///< that was found; on entry a start
};

/// A torque between two bodies that touch in a point or along a line, which is sought along with
/// the forces there: rolling and torsional friction, each bounded by a lever arm times the normal
/// force of the points. What is held at none is no longer when its torque is at that bound.
struct TurningPoint {
  uint32_t a = no_block, b = no_block;
  Vec3 normal = Vec3::UnitY();        ///< unit, from A to B
  std::array<uint32_t, 2> points{};   ///< whose normal forces count
  uint32_t count = 1;                 ///< of these
  double rolling = 0, torsional = 0;  ///< lever arms; 0: no such torque [m]
  Vec3 axis = Vec3::Zero();           ///< unit, along the rolling of B against A; 0: none
  bool ahead = false;                 ///< the rolling turns with its acceleration plus `bias`,
  Vec3 bias = Vec3::Zero();           ///< in the tangent plane [rad/s2]
  double spin = 0;                    ///< sign of the spinning about the normal; 0: none
  Vec3 torque = Vec3::Zero();         ///< on B that was found; on entry a start, world axes [N m]
};

/// Turning of B against A about an axis.
Row turning_row(const TurningPoint& point, const Vec3& axis);

/// The problem that solve_contact_forces() poses, and what it found, for whoever asks for it.
struct ContactForceProblem {
  struct Point {
    int first = 0, count = 1;    ///< its unknowns: the normal force, and with friction two more
    std::array<Vec3, 3> axes{};  ///< along which they act on B, world axes
    double friction = 0;         ///< [-]
  };
  lcp::LcpProblem lcp;        ///< unknowns: forces of points, torques, forces of rows; with its A
  std::vector<Point> points;  ///< as given
  lcp::VecX found;            ///< forces that were found; empty if none were
};

/// How forces of contact are sought.
struct ContactForceMethod {
  /// Asked first. Null, and where the one asked cannot take the problem or does not solve it: the
  /// stages of lcp::solve_cones.
  const lcp::LcpSolverEntry* solver = nullptr;
  lcp::ConeShape cone = lcp::ConeShape::circular;
  /// Of all forces that give the same motion the least sum of squares, which has every symmetry
  /// that the contacts have. Costs a factorisation more.
  bool least = false;
  ContactForceProblem* tell = nullptr;  ///< null: nobody looks
};

/// "circular", "pyramid".
std::span<const std::string_view> all_friction_cones();

/// By the names in lcp::all_lcp_solvers() or "automatic", and in all_friction_cones().
Result<ContactForceMethod> contact_force_method(std::string_view solver, std::string_view cone);

struct ContactForceReport {
  bool solved = true;
  /// Another solver answered than the one that was asked, or sliding forces were sought otherwise.
  bool substituted = false;
  int iterations = 0;
  double residual = 0;                     ///< LcpReport::residual [-]
  std::string_view solver;                 ///< that answered; empty without contacts
  std::vector<lcp::ConeAttempt> attempts;  ///< the last is the one that answered, if any did
};

/// Forces of simultaneous contacts, with friction (Coutinho 2013 §3.5.4, §4.11.4; Baraff 1994): no
/// contact accelerates inwards, none pulls, those that open carry nothing. Where a contact slides,
/// friction is against its slip; where it does not, friction is in the circular cone and either
/// holds it or opposes the acceleration at which it begins to slide.
///
/// `accelerations` hold in v and omega the accelerations of the blocks without contact forces, and
/// afterwards those with them. `forces` are by point, on B, world axes [N], and a start on entry
/// when there are as many as points; those of `rows` and `turning` are found with them. Contacts
/// act through `joints` (§5.6.2), which hold the given accelerations and are to be held again
/// afterwards.
ContactForceReport solve_contact_forces(std::span<DofBlock> accelerations,
                                        std::span<const ForcePoint> points,
                                        const ContactForceMethod& method, std::vector<Vec3>& forces,
                                        const Articulation& joints = {},
                                        std::span<BoundedRow> rows = {},
                                        std::span<TurningPoint> turning = {});

}  // namespace tumble
