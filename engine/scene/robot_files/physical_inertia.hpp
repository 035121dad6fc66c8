#pragma once
#include "engine/math/types.hpp"

#include <optional>

namespace tumble {

/// The physically possible inertia tensor nearest to a given one.
struct PhysicalInertia {
  Mat3 inertia = Mat3::Zero();  ///< [kg m2]
  Vec3 given = Vec3::Zero();    ///< principal moments, ascending
  Vec3 made = Vec3::Zero();     ///< principal moments of the result, ascending
  bool changed = false;         ///< by more than rounding
};

/// A tensor I belongs to a distribution of mass if the second moment of mass S = tr(I)/2 1 - I has
/// no negative eigenvalue (Wensing, Kim and Slotine, "Linear Matrix Inequalities for Physically
/// Consistent Inertial Parameter Identification", 2018, eq. 9): that is the triangle inequality of
/// the principal moments. Negative eigenvalues are set to zero, which gives the nearest S in the
/// Frobenius norm, and tr(S) 1 - S is the result. Empty for a tensor without any positive second
/// moment.
std::optional<PhysicalInertia> physical_inertia(const Mat3& given);

}  // namespace tumble
