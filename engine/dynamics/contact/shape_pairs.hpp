#pragma once
#include "engine/dynamics/bodies/body.hpp"

#include <compare>
#include <cstdint>
#include <vector>

namespace tumble {

/// Which shapes of two bodies, by their places in RigidBody::shapes.
struct ShapesOfPair {
  uint32_t a = 0, b = 0;
  friend auto operator<=>(const ShapesOfPair&, const ShapesOfPair&) = default;
};

/// Two shapes, and how far their bounds are apart at least [m].
struct ShapesNear {
  ShapesOfPair shapes;
  double apart = 0;
};

/// Replaces `out` by all pairs of shapes of two bodies whose bounds are within `reach` of each
/// other [m], and few others, in order. By the trees of bodies of several shapes: the shapes of the
/// one that has fewer near the bounds of the other, then of the other those near each of these.
/// Gives how far all others are apart at least: `reach`, or more where there are none near.
double find_shape_pairs(const RigidBody& a, const RigidBody& b, double reach,
                        std::vector<ShapesNear>& out);

}  // namespace tumble
