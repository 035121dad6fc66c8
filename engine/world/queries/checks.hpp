#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace tumble {

// Checks of the input of queries.

inline Error bad_query(std::string message) {
  return {ErrorCode::invalid_argument, std::move(message), {}, {}};
}

inline Status require_finite(const char* what, const Vec3& v) {
  if (v.allFinite()) return {};
  return bad_query(fmt::format("{} is not finite: ({}, {}, {})", what, v.x(), v.y(), v.z()));
}

/// The distance may be infinite.
inline Status require_distance(double d) {
  if (d >= 0) return {};
  return bad_query(fmt::format("max_distance must be >= 0, got {} m", d));
}

/// A finite pose, with its quaternion normalised.
inline Result<Pose> require_pose(const Pose& pose) {
  const double length = pose.q.norm();
  if (!pose.x.allFinite() || !pose.q.coeffs().allFinite() || !(length > 0))
    return bad_query("pose is not finite, or its quaternion is zero");
  return Pose{pose.x, pose.q.normalized()};
}

}  // namespace tumble
