#pragma once
#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/joints/joint.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Coordinate x of joint `a` is coupled to coordinate y of joint `b`, which may be the same joint:
///   x = ratio y + offset.
/// This is one more row, of up to four bodies: with J_x and J_y for the Jacobians of the
/// coordinates, (J_x - ratio J_y) v = 0. Its forces are F along x and -ratio F along y, which
/// together do no work. Holds what a step reads, and the forces, which are state.
struct JointCoupling {
  uint32_t a = 0, b = 0;  ///< slots of the joints
  uint32_t x = 0, y = 0;  ///< indices among the coordinates of their kinds
  double ratio = 1;       ///< [-], [m/rad] or [rad/m]
  double offset = 0;      ///< [m] or [rad]
  /// F in the two passes of the last sub-step [N] or [N m]: see Joint::moving_force.
  double moving_force = 0, relaxing_force = 0;

  double force() const { return moving_force + relaxing_force; }
  bool same(const JointCoupling& o) const { return a == o.a && b == o.b && x == o.x && y == o.y; }
};

/// Calls f(slot) for the bodies of both joints, except for the world.
template <class F>
void for_bodies(const JointCoupling& c, std::span<const Joint> joints, const F& f) {
  for (const uint32_t joint : {c.a, c.b})
    for (const uint32_t slot : {joints[joint].a, joints[joint].b})
      if (slot != no_body) f(slot);
}

/// The first of these bodies with moves(slot); no_body if there is none.
template <class Moves>
uint32_t first_body(const JointCoupling& c, std::span<const Joint> joints, const Moves& moves) {
  uint32_t first = no_body;
  for_bodies(c, joints, [&](uint32_t slot) {
    if (first == no_body && moves(slot)) first = slot;
  });
  return first;
}
/// Joins all of these bodies with moves(slot) into one set.
template <class Moves>
void join_bodies(const JointCoupling& c, std::span<const Joint> joints, const Moves& moves,
                 DisjointSets& sets) {
  const uint32_t first = first_body(c, joints, moves);
  for_bodies(c, joints, [&](uint32_t slot) {
    if (moves(slot)) sets.join(first, slot);
  });
}

/// A coordinate that is evaluated repeatedly at times near each other: full turns are counted by
/// the mean of the rates at two successive times.
struct FollowedCoordinate {
  double value = 0, rate = 0;  ///< at the last evaluation
  double t = 0;                ///< time of the last evaluation [s]

  /// The coordinate's row now, with full turns in its error.
  JointRow look(const JointCoordinate& coordinate, const JointSides& sides, double now);
};

/// The row of a coupling in two halves, whose errors and rates add up.
struct CouplingRow {
  JointRow of_x, of_y;

  double error() const { return of_x.error + of_y.error; }
  double bias() const { return of_x.bias + of_y.bias; }
  std::array<const RowSide*, 4> sides() const {
    return {&of_x.row.a, &of_x.row.b, &of_y.row.a, &of_y.row.b};
  }
};
/// From the rows of both coordinates, with full turns in their errors.
CouplingRow coupling_row(const JointCoupling& coupling, const JointRow& x, const JointRow& y);

/// Joints and couplings, by slot or index.
struct JointsAndCouplings {
  std::span<const Joint> joints;
  std::span<const JointCoupling> couplings = {};
};
/// A selection of them.
struct JointChoice {
  std::span<const uint32_t> joints;
  std::span<const uint32_t> couplings = {};
};

}  // namespace tumble
