#pragma once
#include "engine/math/types.hpp"

/// Time derivatives of quantities that rotate with angular velocity omega [rad/s] and angular
/// acceleration alpha [rad/s2], both in world axes (Coutinho 2013, Guide to Dynamic Simulations of
/// Rigid Bodies and Particle Systems, 10). All results in world axes unless stated otherwise.
namespace tumble {

/// d r/dt of a vector (world axes) fixed in a rotating body (10.2).
Vec3 attached_rate(const Vec3& r, const Vec3& omega);
/// d2 r/dt2 of the same.
Vec3 attached_second_rate(const Vec3& r, const Vec3& omega, const Vec3& alpha);
/// d r/dt of a vector that changes by `relative_rate` (world axes) as seen from the body (10.2).
Vec3 carried_rate(const Vec3& r, const Vec3& relative_rate, const Vec3& omega);
/// d2 r/dt2 of the same: relative, Coriolis, Euler and centripetal terms.
Vec3 carried_second_rate(const Vec3& r, const Vec3& relative_rate, const Vec3& relative_second_rate,
                         const Vec3& omega, const Vec3& alpha);

/// d R/dt and d2 R/dt2 of the rotation matrix from body to world axes (10.5): [omega]x R.
Mat3 rotation_rate(const Mat3& R, const Vec3& omega);
Mat3 rotation_second_rate(const Mat3& R, const Vec3& omega, const Vec3& alpha);
/// d I/dt of an inertia tensor in world axes that is constant in the body: [omega]x I - I [omega]x.
Mat3 inertia_rate(const Mat3& inertia_world, const Vec3& omega);

/// d q/dt and d2 q/dt2 of the unit quaternion from body to world axes (10.6): (0, omega) q / 2.
/// The results are no unit quaternions.
Quat quaternion_rate(const Quat& q, const Vec3& omega);
Quat quaternion_second_rate(const Quat& q, const Vec3& omega, const Vec3& alpha);
/// The angular velocity of a unit quaternion q with this rate: the vector part of 2 q' q*.
Vec3 omega_of(const Quat& q, const Quat& rate);

/// d (v/|v|)/dt; v is not zero.
Vec3 unit_vector_rate(const Vec3& v, const Vec3& rate);
/// d2 (v/|v|)/dt2; v is not zero.
Vec3 unit_vector_second_rate(const Vec3& v, const Vec3& rate, const Vec3& second_rate);

/// Rates of the two tangents of `tangent_frame(n)` if the unit normal changes by `n_rate`, which
/// must be perpendicular to n (10.4). False within 1e-15 of the one normal at which the frame is
/// discontinuous.
[[nodiscard]] bool tangent_frame_rate(const Vec3& n, const Vec3& n_rate, Vec3& t1_rate,
                                      Vec3& t2_rate);

}  // namespace tumble
