#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Cross-product matrix: skew(a) b = a x b.
Mat3 skew(const Vec3& a);

/// Unit quaternion of a rotation by `angle` [rad] about `axis` (need not be unit; zero gives the
/// identity). Uses math/det, so that the bits are the same on every machine.
Quat axis_angle(const Vec3& axis, double angle);

/// Intrinsic rotations about X, then the new Y, then the new Z: R = Rx Ry Rz; angles in [rad].
Quat euler_xyz(const Vec3& angles);
/// Angles [rad] for which euler_xyz() gives this rotation, the second within a quarter turn. If it
/// is exactly a quarter turn (gimbal lock), the other two are not unique; one pair is returned: the
/// first angle is factored out before the third is computed (Herter and Klott 1993).
Vec3 angles_xyz(const Quat& q);

/// The orientation after rotation with constant world angular velocity `omega` [rad/s] for `h` [s]:
/// the exact exponential, renormalised.
Quat integrate_rotation(const Quat& q, const Vec3& omega, double h);

/// Shortest-path normalised linear interpolation; s in [0, 1].
Quat interpolate(const Quat& a, const Quat& b, double s);
/// Position linearly, orientation along the shortest path.
Pose interpolate(const Pose& a, const Pose& b, double s);

/// The shortest rotation that takes unit vector `a` to unit vector `b`; for opposite vectors a half
/// turn about some axis perpendicular to `a`.
Quat rotation_between(const Vec3& a, const Vec3& b);

/// Two unit vectors that complete the unit normal `n` to a right-handed frame (t1 x t2 = n): the
/// shortest rotation of a fixed frame onto n (Frisvad 2012, "Building an Orthonormal Basis from a
/// 3D Unit Vector Without Normalization", in a form that keeps all digits near its pole).
/// Continuous except at one direction, which no such frame can avoid (hairy ball theorem): it is
/// -(2, 3, 6) / 7, along which few things are built. A rotation of n by d, at angle e from there,
/// rotates the frame by at most about 2 d / e.
void tangent_frame(const Vec3& n, Vec3& t1, Vec3& t2);

}  // namespace tumble
