#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

namespace tumble {

/// How a body or particle moves at one moment. All vectors of this file are in world axes.
struct FrameMotion {
  Vec3 x_world = Vec3::Zero();  ///< centre of mass, or any other point of the body [m]
  Vec3 v = Vec3::Zero();        ///< velocity of that point [m/s]
  Vec3 omega = Vec3::Zero();    ///< angular velocity; zero for a particle [rad/s]

  /// Velocity of the body's material point that is now at `p_world`.
  Vec3 velocity_at(const Vec3& p_world) const { return v + omega.cross(p_world - x_world); }
};

/// Particle, vertex, centre of a sphere, end of a capsule's axis.
struct RoundPoint {
  Vec3 x_world = Vec3::Zero();
  double radius = 0;  ///< of the ball about it [m]
};
/// Edge, or axis of a capsule: an infinite line, valid while its closest point lies on the edge.
struct RoundLine {
  Vec3 x_world = Vec3::Zero();     ///< any point of it
  Vec3 direction = Vec3::UnitX();  ///< of any length > 0
  double radius = 0;               ///< [m]
};
/// Face of a polyhedron, half-space.
struct FlatFace {
  Vec3 x_world = Vec3::Zero();  ///< any point of it
  Vec3 normal = Vec3::UnitY();  ///< unit, outward
};
/// Any smooth surface, at its point closest to the other body.
struct SmoothPoint {
  Vec3 x_world = Vec3::Zero();
  /// Symmetric shape operator: moving along the surface by dx turns the outward normal by
  /// curvature * dx; maps the normal to zero; positive where convex, (1 - n n^T) / r on a sphere
  /// [1/m].
  Mat3 curvature = Mat3::Zero();
};

/// Curvature of the surface F = constant with F growing outwards: P H P / |g|, P = 1 - n n^T.
Mat3 level_set_curvature(const Vec3& gradient, const Mat3& hessian);

/// A contact and its time derivatives (Coutinho 2013, 10.3; Baraff 1992, Dynamic Simulation of
/// Non-Penetrating Rigid Bodies, appendix; Witkin and Baraff 1997, Rigid Body Dynamics II).
///
/// For the closest points w_A, w_B of two surfaces, or the deepest, gap = n.(w_B - w_A), and
/// with u the velocity of the bodies' material points that are at w_B and w_A,
///   gap' = n.(u_B - u_A),
/// because the closest points themselves only slip along surfaces that n is normal to. Hence
///   gap'' = n.[(a_B + alpha_B x r_B) - (a_A + alpha_A x r_A)] + gap_bias,   r = w - x,
///   gap_bias = n'.(u_B - u_A) + n.velocity_bias,
///   velocity_bias = omega_B x (w_B' - v_B) - omega_A x (w_A' - v_A),
/// where w' is how fast the closest point travels. For a vertex on a face at gap 0 that is the
/// known 2 n'.(u_B - u_A) and the centripetal accelerations of the two material points.
struct NormalRate {
  Vec3 normal = Vec3::UnitY();                          ///< n, unit, from A to B
  Vec3 normal_rate = Vec3::Zero();                      ///< n' [1/s]
  double gap = 0;                                       ///< negative is penetration [m]
  double gap_rate = 0;                                  ///< [m/s]
  double gap_bias = 0;                                  ///< gap'' without accelerations [m/s2]
  Vec3 point_a = Vec3::Zero(), point_b = Vec3::Zero();  ///< w_A, w_B
  Vec3 point_rate_a = Vec3::Zero(), point_rate_b = Vec3::Zero();  ///< w_A', w_B' [m/s]
  Vec3 relative_velocity = Vec3::Zero();                          ///< u_B - u_A [m/s]
  /// Rate of change of u_B - u_A at the travelling points without accelerations; its tangential
  /// part enters the conditions of friction where sliding begins [m/s2].
  Vec3 velocity_bias = Vec3::Zero();
};

/// Particle-particle, vertex-vertex, sphere-sphere. Error where the two points coincide.
Result<NormalRate> normal_rate(const FrameMotion& a, const RoundPoint& on_a, const FrameMotion& b,
                               const RoundPoint& on_b);
/// Vertex-face, sphere-plane, particle-plane.
Result<NormalRate> normal_rate(const FrameMotion& a, const RoundPoint& on_a, const FrameMotion& b,
                               const FlatFace& on_b);
Result<NormalRate> normal_rate(const FrameMotion& a, const FlatFace& on_a, const FrameMotion& b,
                               const RoundPoint& on_b);
/// Vertex-edge, sphere-capsule. Error where the point is on the line.
Result<NormalRate> normal_rate(const FrameMotion& a, const RoundPoint& on_a, const FrameMotion& b,
                               const RoundLine& on_b);
Result<NormalRate> normal_rate(const FrameMotion& a, const RoundLine& on_a, const FrameMotion& b,
                               const RoundPoint& on_b);
/// Edge-edge, capsule-capsule. `towards_b` says on which side B is (n.towards_b > 0), which the
/// directions of two crossing lines leave open. Error where the lines are parallel.
Result<NormalRate> normal_rate(const FrameMotion& a, const RoundLine& on_a, const FrameMotion& b,
                               const RoundLine& on_b, const Vec3& towards_b);
/// Two smooth surfaces at their closest points, where the unit normal from A to B is `normal`
/// (Montana 1988, The Kinematics of Contact and Grasp, for gap 0). Error where the surfaces meet
/// along a line or an area.
Result<NormalRate> normal_rate(const FrameMotion& a, const SmoothPoint& on_a, const FrameMotion& b,
                               const SmoothPoint& on_b, const Vec3& normal);

}  // namespace tumble
