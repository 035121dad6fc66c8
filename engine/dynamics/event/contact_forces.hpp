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

/// A closed contact whose force is sought.
struct ForcePoint {
  uint32_t a = no_block, b = no_block;
  Vec3 arm_a = Vec3::Zero(), arm_b = Vec3::Zero();  ///< from the centres of mass, world axes [m]
  Vec3 normal = Vec3::UnitY();                      ///< unit, from A to B
  double bias = 0;                                  ///< ElementGap::bias [m/s2]
  Vec3 tangential_bias = Vec3::Zero();              ///< ElementGap::tangential_bias [m/s2]
  double friction = 0;                              ///< [-]
  bool sliding = false;
  Vec3 slip = Vec3::Zero();  ///< unit, along the slip, if sliding; world axes
};

/// A row along which a force within bounds is sought: hard limits, motors and dry friction of
/// joints.
struct BoundedRow {
  Row row;
  /// The force aims at J a + bias = 0, with J a the acceleration along the row [m/s2] or [rad/s2];
  /// the sum may be positive where the force is at its lower bound, negative at its upper one.
  double bias = 0;
  double least = 0, most = 0;  ///< bounds of the force [N] or [N m]
  double force = 0;            ///< the force found; on entry a first guess
};

/// Rolling and torsional friction between two bodies that touch in a point or along a line, sought
/// along with the forces there. Each is a torque of at most a lever arm times the normal force of
/// the points. A turning that is held at zero begins when its torque reaches that bound.
struct TurningPoint {
  uint32_t a = no_block, b = no_block;
  Vec3 normal = Vec3::UnitY();        ///< unit, from A to B
  std::array<uint32_t, 2> points{};   ///< indices of the points whose normal forces count
  uint32_t count = 1;                 ///< number of these
  double rolling = 0, torsional = 0;  ///< lever arms; 0: no such torque [m]
  Vec3 axis = Vec3::Zero();    ///< unit, along the rolling of B relative to A; 0: held at zero
  bool ahead = false;          ///< friction opposes the rolling to come: acceleration plus `bias`
  Vec3 bias = Vec3::Zero();    ///< in the tangent plane [rad/s2]
  double spin = 0;             ///< sign of the spinning of B about the normal; 0: held at zero
  Vec3 torque = Vec3::Zero();  ///< found, on B; on entry a first guess, world axes [N m]
};

/// The row for the rotation of B relative to A about an axis.
Row turning_row(const TurningPoint& point, const Vec3& axis);

/// The problem that solve_contact_forces() poses and its solution, for whoever wants to inspect it.
struct ContactForceProblem {
  struct Point {
    /// Its unknowns: the normal force, and with friction two tangential ones.
    int first = 0, count = 1;
    std::array<Vec3, 3> axes{};  ///< along which these act on B, world axes
    double friction = 0;         ///< [-]
  };
  lcp::LcpProblem lcp;  ///< unknowns: forces of points, torques, forces of rows; matrix A included
  std::vector<Point> points;  ///< as given
  lcp::VecX found;            ///< the unknowns found; empty if there is no solution
};

/// How contact forces are computed.
struct ContactForceMethod {
  /// The solver that is tried first. If null, or if it cannot treat the problem or does not solve
  /// it, the stages of lcp::solve_cones follow.
  const lcp::LcpSolverEntry* solver = nullptr;
  lcp::ConeShape cone = lcp::ConeShape::circular;
  /// Of all forces that give the same motion, report those with the least sum of squares, which
  /// have every symmetry of the contacts. Costs one more factorisation.
  bool least = false;
  ContactForceProblem* tell = nullptr;  ///< receives the problem; null: not wanted
};

/// "circular", "pyramid".
std::span<const std::string_view> all_friction_cones();

/// Finds a method by the name of its solver in lcp::all_lcp_solvers(), or "automatic", and of its
/// cone in all_friction_cones().
Result<ContactForceMethod> contact_force_method(std::string_view solver, std::string_view cone);

struct ContactForceReport {
  bool solved = true;
  /// Another solver answered than the chosen one, or sliding forces were found by a fallback of
  /// solve_cones.
  bool substituted = false;
  int iterations = 0;
  double residual = 0;      ///< LcpReport::residual [-]
  std::string_view solver;  ///< name of the solver that answered; empty without contacts
  std::vector<lcp::ConeAttempt> attempts;  ///< the last one answered, if any did
};

/// Forces of simultaneous contacts with friction (Coutinho 2013 §3.5.4, §4.11.4; Baraff 1994): no
/// gap accelerates inwards, no contact pulls, contacts that open carry no force. Where a contact
/// slides, friction opposes its slip; where it does not, friction lies in the cone and either holds
/// it or opposes the acceleration at which it begins to slide.
///
/// On entry v and omega of `accelerations` are the accelerations of the blocks without contact
/// forces, on return those with them. `forces` are by point, on B, world axes [N], and a first
/// guess on entry if there are as many as points; the forces of `rows` and torques of `turning` are
/// found with them. Contacts act through `joints` (§5.6.2): the given accelerations must satisfy
/// the joints, and the caller must hold them again afterwards.
ContactForceReport solve_contact_forces(std::span<DofBlock> accelerations,
                                        std::span<const ForcePoint> points,
                                        const ContactForceMethod& method, std::vector<Vec3>& forces,
                                        const Articulation& joints = {},
                                        std::span<BoundedRow> rows = {},
                                        std::span<TurningPoint> turning = {});

}  // namespace tumble
