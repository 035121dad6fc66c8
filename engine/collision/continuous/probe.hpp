#pragma once
#include "engine/math/types.hpp"

#include <vector>

namespace tumble {

/// One distance query of a search for the time of contact.
struct ContactTimeProbe {
  double time = 0;           ///< of the poses for which the distance was computed [s]
  double low = 0, high = 0;  ///< bracket of the first contact, if there is one, so far [s]
  double distance = 0;       ///< 0 where they overlap [m]
  Vec3 on_a = Vec3::Zero();  ///< nearest points, world [m]
  Vec3 on_b = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B
  double speed = 0;  ///< bound on the closing speed along the normal; 0 where none is used [m/s]
};

/// Receives each query in turn, for drawing the search; null costs one test per query.
using ContactTimeTrace = std::vector<ContactTimeProbe>;

}  // namespace tumble
