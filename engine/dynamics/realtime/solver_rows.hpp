#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/course_motion.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/realtime/coupled_joints.hpp"
#include "engine/dynamics/realtime/drive_row.hpp"
#include "engine/dynamics/realtime/joint_block.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"
#include "engine/dynamics/realtime/spring_row.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"
#include "engine/dynamics/realtime/turning_row.hpp"

#include <cstdint>
#include <span>

namespace tumble {

/// A body as the inner loops see it. Every island has its own copies of the kinematic bodies that
/// touch it, and one body that stands for all fixed ones; these have zero inverse mass.
struct SolverBody {
  Vec3 v = Vec3::Zero();    ///< [m/s]
  Vec3 w = Vec3::Zero();    ///< angular velocity, world axes [rad/s]
  double inverse_mass = 0;  ///< [1/kg]
  /// World axes; of the start of the tick, unless lever arms follow the body or a joint holds it.
  Mat3 inverse_inertia = Mat3::Zero();
  Vec3 dx = Vec3::Zero();    ///< displacement since the start of the tick [m]
  Mat3 turn = Mat3::Zero();  ///< rotation since the start of the tick, minus identity
};

/// What only the integration of a body needs.
struct SolverMotion {
  uint32_t slot = ~uint32_t{0};  ///< slot of the body; ~0 for the one that stands for fixed bodies
  Quat dq = Quat::Identity();    ///< rotation since the start of the tick
  Vec3 acceleration = Vec3::Zero();  ///< by gravity and force, or of a course [m/s2]
  Vec3 turning = Vec3::Zero();       ///< angular acceleration of a course [rad/s2]
  bool on_course = false;            ///< kinematic, with a velocity that changes within the tick
  bool dynamic = false;
  bool spherical = false;  ///< all moments of inertia are equal: no gyroscopic term
  bool spins = false;  ///< turns so far in a tick, or is so slender, that lever arms must follow
  /// Held by a joint: its inertia and gyroscopic term are updated in every sub-step.
  bool jointed = false;
  Vec3 v_before, w_before;  ///< before an impact
};

/// Whether a body turns so far in a tick of `h` seconds that lever arms must follow it.
inline bool turns_fast(const RigidBody& body, double h) {
  constexpr double angle = tolerances::arms_follow_turn;
  return body.omega.squaredNorm() * h * h > angle * angle;
}

/// Stiffness of a contact or joint as factors of the soft step (Catto, "Solver2D").
struct Softness {
  double bias_rate = 0;      ///< [1/s]
  double mass_scale = 1;     ///< [-]
  double impulse_scale = 0;  ///< [-]
};
Softness soft_step(double frequency, double damping_ratio, double h);

struct ContactSoftness {
  Softness soft;
  Softness hard;  ///< of contacts with twice the frequency (is_hard)
};
ContactSoftness contact_softness(const RealtimeSettings& settings, double hs);
/// Whether a contact has the higher stiffness: against immovable bodies, and where two round
/// surfaces touch, since there a single point bears the load that otherwise four share, and the
/// bodies cannot rock on it. A round body that touches a flat face is as soft as faces on faces: a
/// ball stiffer than the boxes around it keeps heaps awake for longer. Contacts with restitution
/// stay soft, since they would gain energy; so do `delicate` pairs, of which a body turns fast, is
/// slender or is held by joints: they would be pressed through thin bodies, or their joints pulled
/// apart.
bool is_hard(const Contact& contact, bool both_move, bool delicate);

/// One contact of an island.
struct ContactRow {
  uint32_t a = 0, b = 0;  ///< solver bodies
  uint32_t first = 0;     ///< index of its first PointRow
  uint32_t count = 0;
  uint32_t source = 0;  ///< index into the contact set
  bool spins = false;  ///< lever arms of a body of it follow the rotation: refreshed every sub-step
  Vec3 n, t1, t2;      ///< contact frame, world axes
  double rounding_a = 0, rounding_b = 0;  ///< Contact::rounding_a, _b [m]
  double friction = 0;
  double target1 = 0, target2 = 0;  ///< velocity of belts along t1 and t2 [m/s]
  Softness soft;
  bool resists_turning = false;  ///< whether `turning` acts
  TurningRow turning;
};

/// One point of a contact. Impulses are those of one sub-step.
struct PointRow {
  Vec3 ra, rb;             ///< lever arms, world axes [m]
  double gap = 0;          ///< constant part: the present gap is gap + n.(moved_b - moved_a) [m]
  double normal_mass = 0;  ///< 1 / (n K n), with K the mobility at the point [kg]
  double m11 = 0, m12 = 0, m22 = 0;  ///< inverse of K in the tangent plane [kg]
  double tangent_mass = 0;           ///< 1 / its larger eigenvalue [kg]
  double normal = 0;                 ///< impulses along n, t1, t2 [N s]
  double tangent1 = 0, tangent2 = 0;
  double normal_sum = 0;  ///< over the tick [N s]
  double tangent1_sum = 0, tangent2_sum = 0;
  double bounce = 0;   ///< separation speed by restitution; 0 for none [m/s]
  double rebound = 0;  ///< impulse of restitution, part of normal_sum [N s]
  // For points that bounce in islands with joints.
  double speed_before = 0;   ///< normal speed before a pass, or before the impact [m/s]
  double normal_before = 0;  ///< normal impulse that does not belong to the pass [N s]
};

/// The part of the solver's memory that belongs to one island.
struct SolverIsland {
  std::span<SolverBody> bodies;
  std::span<SolverMotion> motions;
  std::span<ContactRow> rows;
  std::span<PointRow> points;
  std::span<JointBlock> joints;
  int joint_sweeps = 1;  ///< in each pass, before the bodies move and after it
  /// Of the joints; may contain more than those of this island's joints.
  std::span<DriveRow> drives = {};
  std::span<CoupledJoints> coupled = {};
  std::span<SpringRow> springs = {};
  std::span<SpringTurn> spring_turns = {};
  double kick = 0;  ///< time for which forces act in a sub-step before the joints are solved [s]
  Softness joint_softness = {};  ///< of the correcting pass
};

/// Errors that the last sub-step left.
struct SolveResiduals {
  double contacts = 0;  ///< greatest approach speed at a pressed point [m/s]
  double joints = 0;    ///< greatest velocity left in a row of a joint [m/s, rad/s]
};

struct SolverContext {
  std::span<RigidBody> bodies;
  std::span<Contact> contacts;
  Vec3 gravity;
  double h = 0;  ///< length of the tick, or of the present part [s]
  const RealtimeSettings* settings = nullptr;
  std::span<Joint> joints;
  std::span<JointPush> joint_pushes = {};  ///< by joint, or empty
  std::span<JointCoupling> couplings = {};
  double passed = 0;  ///< time of the tick that is over, if `h` is a part of it [s]
  std::span<SolvedSpring> springs = {};
  std::span<const CourseMotion> courses = {};  ///< of kinematic bodies, by slot
};

/// The velocity of a body from which its sub-steps of `hs` seconds begin, in which forces act for
/// `kick` seconds before joints and contacts are solved. The velocity of a kinematic body on a
/// course changes with every kick at its constant rate, such that the body moves with its mean
/// velocity over each sub-step.
BodyVelocity first_velocity(const SolverContext& context, uint32_t slot, double hs, double kick);

/// The present gap at a point of a contact.
double gap_of(const SolverIsland& island, const ContactRow& row, const PointRow& p);

/// Fills in bodies, rows and points for sub-steps of `hs`; rows come with a, b, first, count and
/// source set.
void prepare_rows(const SolverContext& context, const SolverIsland& island, double hs);
/// After bodies moved: updates lever arms and masses of rows with `spins` to the present
/// orientations.
void refresh_spinning_rows(const SolverContext& context, const SolverIsland& island);
/// Applies the impulses of the previous sub-step.
void warm_start(const SolverIsland& island);
/// One sweep over all rows; with `bias` it also corrects overlap.
void solve_rows(const SolverIsland& island, double hs, double push_out_speed, bool bias);
/// Solves sliding friction once more, bounded by the normal impulses at the end of the sub-step.
/// Those of the sweep with bias are too small while a soft contact yields, and friction would be
/// too small as well. Not in islands with joints, which impulses after the relaxing pass would pull
/// apart.
void solve_friction_again(const SolverIsland& island);
/// Used instead in islands with joints, before the sweep without bias: computes the normal impulses
/// at the end of the sub-step, as bounds of the friction in that sweep.
void solve_normals(const SolverIsland& island, double hs, double push_out_speed);
/// Adds the impulses of the sub-step to the sums of the tick.
void sum_impulses(const SolverIsland& island);
/// Applies restitution. Between bodies that turn fast it gives a pair no more energy than it lost
/// in the tick: the approach was measured at the start, and the point that touches may be slower.
/// Returns the greatest change, as a share of the wanted speed; 0 if nothing bounced. Other points
/// and joints may remove a part of it, so that it is repeated in turn with these; only then are
/// impulses of restitution reduced again.
double apply_restitution(const SolverContext& context, const SolverIsland& island);

/// Writes the impulses back to the contacts; returns the greatest approach speed at a pressed
/// point.
double store_rows(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
