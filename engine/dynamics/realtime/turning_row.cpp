// Rolling and torsional friction; the same over lanes: solve_turning in wide/contact_kernels.cpp.
#include "engine/dynamics/realtime/turning_row.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

void TurningRow::set_masses(const Mat3& mobility) {
  const double k11 = mobility(0, 0), k12 = mobility(0, 1), k22 = mobility(1, 1);
  const double det = k11 * k22 - k12 * k12;
  m11 = k22 / det;
  m12 = -k12 / det;
  m22 = k11 / det;
  const double half = 0.5 * (k11 + k22), diff = 0.5 * (k11 - k22);
  rolling_mass = 1 / (half + std::sqrt(diff * diff + k12 * k12));
  torsional_mass = 1 / mobility(2, 2);
  k13 = mobility(0, 2);
  k23 = mobility(1, 2);
}

Vec3 TurningRow::solve(const Vec3& turning, double pressure) {
  const double limit = rolling * pressure;
  double r1 = impulse.x() - (m11 * turning.x() + m12 * turning.y());
  double r2 = impulse.y() - (m12 * turning.x() + m22 * turning.y());
  if (r1 * r1 + r2 * r2 > limit * limit) {
    // Rolling continues: a gradient step, whose fixed point opposes the rolling in every direction
    // alike.
    r1 = impulse.x() - rolling_mass * turning.x();
    r2 = impulse.y() - rolling_mass * turning.y();
    const double length2 = r1 * r1 + r2 * r2;
    if (length2 > limit * limit) {
      const double scale = limit / std::sqrt(length2);
      r1 *= scale;
      r2 *= scale;
    }
  }
  const double most = torsional * pressure;
  // A slanted needle turns about its axis by both torques: the second takes the first into account.
  const double spinning = turning.z() + k13 * (r1 - impulse.x()) + k23 * (r2 - impulse.y());
  const double spin = std::clamp(impulse.z() - torsional_mass * spinning, -most, most);
  const Vec3 next(r1, r2, spin), change = next - impulse;
  impulse = next;
  return change;
}

}  // namespace tumble
