#pragma once
#include "engine/collision/field_pairs/tolerances.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"

namespace tumble {

/// The sample of a field at a point, in the field's frame.
struct FieldPoint {
  Vec3 x = Vec3::Zero();
  double distance = 0;           ///< [m]
  Vec3 gradient = Vec3::Zero();  ///< about unit length; shorter where two sides are equally near
  double error = 0;              ///< of the distance [m]

  bool has_direction() const {
    return gradient.squaredNorm() > tolerances::no_gradient * tolerances::no_gradient;
  }
  Vec3 normal() const { return gradient.normalized(); }
  /// Lower bound of the exact distance at any point within `way` of this one [m].
  double least_within(double way) const { return distance - error - way; }
};

inline FieldPoint field_point(const DistanceField& field, const Vec3& x) {
  const DistanceSample s = field.sample(x);
  return {x, s.distance, s.gradient, s.error};
}

}  // namespace tumble
