#pragma once
#include "engine/math/types.hpp"

#include <optional>

namespace tumble {

/// The inertia tensor that a body can have which is nearest to a given one.
struct PhysicalInertia {
  Mat3 inertia = Mat3::Zero();  ///< [kg m2]
  Vec3 given = Vec3::Zero();    ///< principal moments, ascending
  Vec3 made = Vec3::Zero();     ///< likewise, of the result
  bool changed = false;         ///< by more than rounding
};

/// A tensor I belongs to a distribution of mass when the second moment of mass
/// S = tr(I)/2 1 - I has no negative eigenvalue (Wensing, Kim and Slotine, "Linear Matrix
/// Inequalities for Physically Consistent Inertial Parameter Identification", 2018, eq. 9): that is
/// the triangle inequality of the principal moments. Negative eigenvalues are set to zero, which is
/// the nearest S in the Frobenius norm, and tr(S) 1 - S is the answer. Nothing for a tensor without
/// any positive second moment.
std::optional<PhysicalInertia> physical_inertia(const Mat3& given);

}  // namespace tumble
