#pragma once
#include "engine/dynamics/realtime/joint_pass.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

constexpr size_t wide_lanes = 16;  ///< lanes of every bundle, on every machine

/// One value of each of the contacts, points or bodies of a bundle.
struct alignas(64) LaneFloats {
  std::array<float, wide_lanes> v{};
  float& operator[](size_t lane) { return v[lane]; }
  float operator[](size_t lane) const { return v[lane]; }
};
using LaneVec = std::array<LaneFloats, 3>;
using LaneSym = std::array<LaneFloats, 6>;  ///< symmetric: xx, xy, xz, yy, yz, zz

/// State of a body within the tick, relative to its start, world axes. Four groups of four floats,
/// so that several bodies are read and written by transposition.
struct alignas(64) WideBody {
  std::array<float, 3> v{};             ///< [m/s]
  std::array<float, 3> w{};             ///< angular velocity [rad/s]
  std::array<float, 3> dx{};            ///< displacement [m]
  std::array<float, 3> turn{};          ///< vector part of the rotation as a quaternion, w >= 0
  std::array<float, 3> acceleration{};  ///< by gravity and force [m/s2]
  float spare = 0;
};

/// What preparation of rows needs of a body.
struct alignas(64) WideMass {
  std::array<float, 4> q{0, 0, 0, 1};      ///< orientation at the start, x y z w
  float inverse_mass = 0;                  ///< 0 for immovable bodies [1/kg]
  std::array<float, 6> inverse_inertia{};  ///< world axes, as LaneSym
  float uneven = 0;                        ///< 1 if the moments of inertia differ
  std::array<float, 4> spare{};
};

/// What only the integration needs, of wide_lanes consecutive bodies, one in each lane.
struct WideMotion {
  LaneVec alpha;          ///< angular acceleration by torque [rad/s2]
  LaneSym inertia;        ///< world axes, at the start [kg m2]
  LaneSym inverse;        ///< inverse of that [1/(kg m2)]
  LaneFloats gyroscopic;  ///< 1 if the moments of inertia differ
  /// Velocities after the last kick; changes since then are by impulses.
  LaneVec kicked_v, kicked_w;
};

/// Rolling and torsional friction of the contacts of a bundle, if any has them: as TurningRow, by
/// lane; zeros for contacts without.
struct WideTurning {
  LaneFloats rolling, torsional;
  LaneFloats m11, m12, m22, torsional_mass, k13, k23;
  LaneVec impulse;  ///< before preparation: torque, world axes
  LaneVec sum;
};

/// Contacts of a bundle, no two of which share a movable body; lanes without a contact have zero
/// masses.
struct WideContact {
  alignas(64) std::array<uint32_t, wide_lanes> a{}, b{};  ///< bodies
  std::array<uint32_t, wide_lanes> source{};              ///< index into the contact set
  std::array<uint32_t, wide_lanes> counts{};              ///< points of each
  LaneVec n, t1;                                          ///< t2 is n x t1
  LaneFloats mass_a, mass_b;                              ///< inverse [1/kg]
  LaneSym inertia_a, inertia_b;                           ///< inverse, world axes
  LaneFloats friction, restitution;
  LaneFloats hard;                    ///< 1 for contacts with is_hard
  LaneFloats rounding_a, rounding_b;  ///< Contact::rounding_a, _b [m]
  LaneFloats target1, target2,
      target3;  ///< velocity of belts: world axes before preparation, then along t1 and t2
  static constexpr uint32_t no_turning = ~uint32_t{0};
  uint32_t turning = no_turning;        ///< index of its WideTurning
  uint32_t first = 0;                   ///< index of its first WidePoint
  uint32_t count = 0;                   ///< greatest of `counts`
  uint32_t lanes = 0;                   ///< number of contacts, in the first lanes
  uint16_t writes_a = 0, writes_b = 0;  ///< bit k: that body of lane k is dynamic
  bool rounds = false, bounces = false;
};

/// One point of each contact of a bundle; impulses are those of one sub-step, as in PointRow.
struct WidePoint {
  LaneVec ra, rb;  ///< lever arms, world axes; before preparation anchors, body axes [m]
  LaneFloats gap;
  LaneFloats normal_mass, m11, m12, m22;
  LaneFloats normal, tangent1,
      tangent2;  ///< before preparation: normal force, friction force x and y, world axes
  /// Before preparation tangent1_sum: friction force z.
  LaneFloats normal_sum, tangent1_sum, tangent2_sum;
  LaneFloats bounce;
};

/// Ball joints and hinges of a bundle, no two of which share a movable body. Impulses are those of
/// one sub-step, on B. Lanes without a joint have zero masses.
struct WideJoint {
  static constexpr uint32_t no_hinge = ~uint32_t{0};
  alignas(64) std::array<uint32_t, wide_lanes> a{}, b{};  ///< bodies
  std::array<uint32_t, wide_lanes> source{};              ///< index into the joints
  LaneVec at_a, at_b;  ///< arms at the start of the tick, world axes; 0 of fixed bodies [m]
  LaneVec apart;       ///< from A's anchor to B's at the start [m]
  LaneVec ra, rb;      ///< arms now [m]
  /// Moving pass: half hs times the velocity-dependent bias, added to the velocity to be removed
  /// [m/s]
  LaneVec target;
  LaneVec correction;         ///< correcting pass: velocity that reduces the error, likewise [m/s]
  LaneFloats mass_a, mass_b;  ///< inverse [1/kg]
  LaneSym inertia_a, inertia_b;  ///< inverse, world axes, now
  /// Lower triangle of JointBlock::factor by rows, the first three rows.
  std::array<LaneFloats, 6> factor;
  LaneVec impulse, moment_a, moment_b;   ///< JointPush of the sub-steps so far
  LaneVec moving, correcting, relaxing;  ///< as in JointBlock [N s]
  uint32_t hinge = no_hinge;             ///< index of its WideHinge
  uint32_t lanes = 0;                    ///< number of joints, in the first lanes
  uint16_t writes_a = 0, writes_b = 0;   ///< bit k: that body of lane k is dynamic
  LaneFloats uneven;  ///< above 0 if the moments of inertia of one of its bodies differ
  bool any_uneven = false;
  bool any_struck = false;
  LaneFloats struck;  ///< above 0 while an impact spreads through the joint's island
};

/// What hinges have besides: an axis of B stays perpendicular to two axes of A.
struct WideHinge {
  LaneVec x_a, y_a, z_b;        ///< those axes at the start of the tick, world axes
  std::array<LaneVec, 2> turn;  ///< Jacobian at present: on B; the negative on A
  LaneVec twist;                ///< JointPush::twist of the sub-steps so far
  std::array<LaneFloats, 2> target, correction;            ///< as those of WideJoint [rad/s]
  std::array<LaneFloats, 9> factor;                        ///< the last two rows of the triangle
  std::array<LaneFloats, 2> moving, correcting, relaxing;  ///< [N m s]
};

/// The impulses of a pass.
inline LaneVec& impulses(WideJoint& j, JointPass pass) {
  if (pass == JointPass::relaxing) return j.relaxing;
  return pass == JointPass::moving ? j.moving : j.correcting;
}
inline std::array<LaneFloats, 2>& impulses(WideHinge& h, JointPass pass) {
  if (pass == JointPass::relaxing) return h.relaxing;
  return pass == JointPass::moving ? h.moving : h.correcting;
}

/// Impulses of a WideJoint and its WideHinge before an impact.
struct WideRemembered {
  LaneVec moving, relaxing;
  std::array<LaneFloats, 2> turning_moving, turning_relaxing;
};

struct WideSoftness {
  float bias_rate = 0, mass_scale = 1, impulse_scale = 0;
};

struct WideStep {
  float hs = 0;  ///< sub-step [s]
  float push_out_speed = 0;
  float restitution_threshold = 0;
  WideSoftness soft, hard;
  float joint_rate = 0;  ///< rate at which the correcting pass reduces errors [1/s]
};

/// The arrays that the kernels work on; WideIsland owns them.
struct WideRows {
  std::vector<WideBody> bodies;       ///< those that the kernels integrate come first
  std::vector<WideMass> masses;       ///< by body
  std::vector<WideMotion> motions;    ///< by block of wide_lanes bodies
  std::vector<WideContact> contacts;  ///< sorted by colour
  std::vector<WidePoint> points;
  std::vector<WideTurning> turnings;
  std::vector<WideJoint> joints;  ///< sorted by colour
  std::vector<WideHinge> hinges;
  std::vector<WideRemembered> remembered;  ///< by bundle of joints, in ticks with an impact
  // In ticks in which something bounces.
  std::vector<LaneFloats> rebounds;      ///< by point: PointRow::rebound [N s]
  std::vector<LaneFloats> blow_changes;  ///< by bundle of contacts: result of apply_restitution [-]
};

}  // namespace tumble
