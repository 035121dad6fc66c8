#pragma once
#include "engine/math/types.hpp"

namespace tumble {

/// Principal moments and axes of an inertia tensor.
struct PrincipalAxes {
  Vec3 moments = Vec3::Zero();   ///< ascending [kg m^2]
  Mat3 axes = Mat3::Identity();  ///< columns: unit axes, right-handed; inertia = axes diag axes^T
  Quat rotation = Quat::Identity();  ///< of `axes`, with w >= 0
};

/// Eigenvectors of a symmetric matrix by cyclic Jacobi rotations (Golub & Van Loan §8.5), from
/// + - * / and sqrt only: the same bits everywhere. The lower triangle is read. A diagonal matrix
/// gives its own axes, reordered. Each axis is signed so that its largest component is positive,
/// the third so that the frame is right-handed.
PrincipalAxes principal_axes(const Mat3& inertia);

}  // namespace tumble
