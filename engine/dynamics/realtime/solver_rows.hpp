#pragma once
#include "engine/dynamics/bodies/body.hpp"
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
/// touch it and one that stands for all fixed bodies; both have zero inverse mass.
struct SolverBody {
  Vec3 v = Vec3::Zero();                ///< [m/s]
  Vec3 w = Vec3::Zero();                ///< angular velocity, world axes [rad/s]
  double inverse_mass = 0;              ///< [1/kg]
  Mat3 inverse_inertia = Mat3::Zero();  ///< world axes; of the start of the tick unless it spins
  Vec3 dx = Vec3::Zero();               ///< displacement since the start of the tick [m]
  Mat3 turn = Mat3::Zero();             ///< rotation since the start of the tick, minus identity
};

/// What only the integration of a body needs.
struct SolverMotion {
  uint32_t slot = ~uint32_t{0};      ///< of the body; none for the fixed one
  Quat dq = Quat::Identity();        ///< rotation since the start of the tick
  Vec3 acceleration = Vec3::Zero();  ///< by gravity and force [m/s2]
  bool dynamic = false;
  bool spherical = false;  ///< all moments of inertia are equal: no gyroscopic term
  bool spins = false;    ///< turns so far in a tick, or is so slender, that lever arms must follow
  bool jointed = false;  ///< held by a joint, which feels its inertia as it is
  Vec3 v_before, w_before;  ///< before a blow
};

/// Whether a body turns so far in a tick of `h` seconds that lever arms must follow it.
inline bool turns_fast(const RigidBody& body, double h) {
  constexpr double angle = tolerances::arms_follow_turn;
  return body.omega.squaredNorm() * h * h > angle * angle;
}

/// Stiffness of a contact as factors of the soft step (Catto, "Solver2D").
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
/// Whether a contact is as stiff as it may be: against what cannot give way, and where two round
/// surfaces touch, as there one point bears the load that others share among four, and nothing can
/// rock on it. Beside flat faces round bodies are soft as these are: a ball that is stiffer than
/// the boxes it lies among keeps heaps awake for longer. So is what bounces, which would gain
/// energy, and `delicate` pairs, of which a body spins, is slender or hangs in joints: they would
/// press each other through glass, or joints apart.
bool is_hard(const Contact& contact, bool both_move, bool delicate);

/// One contact of an island.
struct ContactRow {
  uint32_t a = 0, b = 0;  ///< solver bodies
  uint32_t first = 0;     ///< its first PointRow
  uint32_t count = 0;
  uint32_t source = 0;                    ///< index into the contact set
  bool spins = false;                     ///< a body of it spins: refreshed every sub-step
  Vec3 n, t1, t2;                         ///< contact frame, world axes
  double rounding_a = 0, rounding_b = 0;  ///< Contact::rounding_a, _b [m]
  double friction = 0;
  double target1 = 0, target2 = 0;  ///< slip velocity that belts ask for, along t1 and t2 [m/s]
  Softness soft;
  bool resists_turning = false;  ///< its TurningRow acts
  TurningRow turning;
};

/// One point of a contact. Impulses are those of one sub-step.
struct PointRow {
  Vec3 ra, rb;                       ///< lever arms, world axes [m]
  double gap = 0;                    ///< so that gap + n.(moved_b - moved_a) is the gap now [m]
  double normal_mass = 0;            ///< 1 / (n K n) [kg]
  double m11 = 0, m12 = 0, m22 = 0;  ///< inverse of K in the tangent plane [kg]
  double tangent_mass = 0;           ///< 1 / its larger eigenvalue [kg]
  double normal = 0;                 ///< [N s]
  double tangent1 = 0, tangent2 = 0;
  double normal_sum = 0;  ///< over the tick [N s]
  double tangent1_sum = 0, tangent2_sum = 0;
  double bounce = 0;   ///< separation speed that restitution asks for; 0 for none [m/s]
  double rebound = 0;  ///< impulse of restitution, part of normal_sum [N s]
  // Beside joints, of points that bounce.
  double speed_before = 0;   ///< normal speed before a pass, then before the blow [m/s]
  double normal_before = 0;  ///< its normal impulse that is no part of the pass [N s]
};

/// The part of the scratch memory that belongs to one island.
struct SolverIsland {
  std::span<SolverBody> bodies;
  std::span<SolverMotion> motions;
  std::span<ContactRow> rows;
  std::span<PointRow> points;
  std::span<JointBlock> joints;
  int joint_sweeps = 1;             ///< before the bodies move, and after it
  std::span<DriveRow> drives = {};  ///< of the joints, and of others
  std::span<CoupledJoints> coupled = {};
  std::span<SpringRow> springs = {};
  std::span<SpringTurn> spring_turns = {};
  double kick = 0;               ///< how long forces act in a sub-step before joints do [s]
  Softness joint_softness = {};  ///< of the correcting pass
};

/// What the last sub-step left.
struct SolveResiduals {
  double contacts = 0;  ///< greatest approach speed at a pressed point [m/s]
  double joints = 0;    ///< greatest velocity left in a row of a joint [m/s, rad/s]
};

struct SolverContext {
  std::span<RigidBody> bodies;
  std::span<Contact> contacts;
  Vec3 gravity;
  double h = 0;  ///< tick [s]
  const RealtimeSettings* settings = nullptr;
  std::span<Joint> joints;
  std::span<JointPush> joint_pushes = {};  ///< by joint, or none
  std::span<JointCoupling> couplings = {};
  double passed = 0;  ///< of the tick, when `h` is a part of it [s]
  std::span<SolvedSpring> springs = {};
};

/// Fills bodies, rows and points for sub-steps of `hs`; rows come with a, b, first, count, source
/// set.
void prepare_rows(const SolverContext& context, const SolverIsland& island, double hs);
/// Lever arms and masses of rows with spinning bodies at the present orientation; after positions
/// moved.
void refresh_spinning_rows(const SolverContext& context, const SolverIsland& island);
/// Starts from the impulses of the sub-step before.
void warm_start(const SolverIsland& island);
/// One sweep over all rows; with bias it also works off penetration.
void solve_rows(const SolverIsland& island, double hs, double push_out_speed, bool bias);
/// Sliding friction once more, bounded by the normal impulses with which the sub-step ends. Those
/// of the sweep with bias lack what a body sinks in by, and friction would lose as much for good.
/// Not beside joints: what comes after their relaxing pass pulls them apart.
void solve_friction_again(const SolverIsland& island);
/// Beside joints instead, before the sweep without bias: normal impulses as the sub-step ends with
/// them, as bounds of the friction in that sweep.
void solve_normals(const SolverIsland& island, double hs, double push_out_speed);
/// Adds the impulses of the sub-step to the sums of the tick.
void sum_impulses(const SolverIsland& island);
/// Bounces. Between spinning bodies none gives the pair more energy than it had before the tick:
/// the approach was measured then, and the point that comes to touch may be slower.
/// The greatest change, as a share of the speed that was asked for; 0 when nothing bounced. Joints
/// may take some of it away again: both are repeated in turn, which only then takes back anything.
double apply_restitution(const SolverContext& context, const SolverIsland& island);

/// Writes the impulses back to the contacts; gives the greatest approach speed at a pressed point.
double store_rows(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
