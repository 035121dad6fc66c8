#pragma once
#include "engine/math/types.hpp"

#include <vector>

namespace tumble {

/// One distance query of a search for the time of contact.
struct ContactTimeProbe {
  double time = 0;           ///< of the poses that were measured [s]
  double low = 0, high = 0;  ///< what the first contact, if any, is known to lie between by now [s]
  double distance = 0;       ///< 0 where they overlap [m]
  Vec3 on_a = Vec3::Zero();  ///< nearest points, world [m]
  Vec3 on_b = Vec3::Zero();
  Vec3 normal = Vec3::Zero();  ///< unit, from A to B
  double speed = 0;  ///< bound on the closing speed along the normal; 0 where none is used [m/s]
};

/// Receives each query in turn, for drawing the search; null costs one test a query.
using ContactTimeTrace = std::vector<ContactTimeProbe>;

}  // namespace tumble
