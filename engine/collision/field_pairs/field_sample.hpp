#pragma once
#include "engine/collision/field_pairs/tolerances.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"

namespace tumble {

/// What a field says at a point, in its own frame.
struct FieldPoint {
  Vec3 x = Vec3::Zero();
  double distance = 0;           ///< [m]
  Vec3 gradient = Vec3::Zero();  ///< of about unit length; short on a ridge of the distance
  double error = 0;              ///< of the distance [m]

  bool has_direction() const {
    return gradient.squaredNorm() > tolerances::no_gradient * tolerances::no_gradient;
  }
  Vec3 normal() const { return gradient.normalized(); }
  /// The exact distance is no less anywhere within `way` of the point [m].
  double least_within(double way) const { return distance - error - way; }
};

inline FieldPoint field_point(const DistanceField& field, const Vec3& x) {
  const DistanceSample s = field.sample(x);
  return {x, s.distance, s.gradient, s.error};
}

}  // namespace tumble
