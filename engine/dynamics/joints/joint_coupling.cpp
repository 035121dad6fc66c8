#include "engine/dynamics/joints/joint_coupling.hpp"

namespace tumble {
namespace {

/// The row times a factor.
JointRow scaled(const JointRow& row, double factor) {
  JointRow out = row;
  for (RowSide* side : {&out.row.a, &out.row.b}) {
    side->linear *= factor;
    side->angular *= factor;
  }
  out.error *= factor;
  out.bias *= factor;
  return out;
}

}  // namespace

JointRow FollowedCoordinate::look(const JointCoordinate& coordinate, const JointSides& sides,
                                  double now) {
  JointRow row = coordinate.row(sides);
  const double rate_now = row_rate(row, sides);
  if (coordinate.turns)
    row.error = nearest_turn(row.error, value + 0.5 * (now - t) * (rate + rate_now));
  *this = {row.error, rate_now, now};
  return row;
}

CouplingRow coupling_row(const JointCoupling& coupling, const JointRow& x, const JointRow& y) {
  CouplingRow out{x, scaled(y, -coupling.ratio)};
  out.of_x.error -= coupling.offset;
  return out;
}

}  // namespace tumble
