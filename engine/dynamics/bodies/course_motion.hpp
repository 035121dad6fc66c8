#pragma once
#include "engine/math/types.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace tumble {

/// Velocities of a body; for impulses, their mean before and after.
struct BodyVelocity {
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();
};

/// Motion of a kinematic body whose velocity changes at a constant rate during a tick.
struct CourseMotion {
  uint32_t slot = 0;
  BodyVelocity at_start;  ///< at the start of the tick
  BodyVelocity change;    ///< rate of change [1/s of the above]

  /// So many seconds after the start of the tick.
  BodyVelocity at(double t) const {
    return {at_start.v + t * change.v, at_start.omega + t * change.omega};
  }
};

/// The motion of a body among these, which are sorted by slot; null if it is not one of them.
inline const CourseMotion* course_of(std::span<const CourseMotion> courses, uint32_t slot) {
  const auto at = std::ranges::lower_bound(courses, slot, {}, &CourseMotion::slot);
  return at != courses.end() && at->slot == slot ? &*at : nullptr;
}

}  // namespace tumble
