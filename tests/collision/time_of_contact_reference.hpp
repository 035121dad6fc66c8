#pragma once
#include "engine/collision/motion.hpp"
#include "tests/collision/support.hpp"

#include <cmath>

/// Where moving shapes are, in extended precision and by other formulas than the engine's.
namespace tumble::test {

using LongVec = Vector3<long double>;
using LongMat = Matrix3<long double>;

struct LongPose {
  LongVec x;
  LongMat R;
};

inline LongMat long_matrix(const Quat& q) {
  const long double w = q.w(), x = q.x(), y = q.y(), z = q.z(), n = w * w + x * x + y * y + z * z;
  const LongMat R(w * w + x * x - y * y - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y),
                  2 * (x * y + w * z), w * w - x * x + y * y - z * z, 2 * (y * z - w * x),
                  2 * (x * z - w * y), 2 * (y * z + w * x), w * w - x * x - y * y + z * z);
  return R / n;
}

/// Rodrigues' formula about the carrier.
inline LongPose long_pose(const Motion& m, long double t) {
  const long double h = t - static_cast<long double>(m.t0);
  const LongVec omega = m.omega.cast<long double>();
  const long double spin = omega.norm();
  LongMat turn = LongMat::Identity();
  if (spin > 0) {
    const LongVec u = omega / spin;
    const LongMat k(0, -u.z(), u.y(), u.z(), 0, -u.x(), -u.y(), u.x(), 0);
    turn += sinl(spin * h) * k + (1 - cosl(spin * h)) * (k * k);
  }
  const LongMat carrier = turn * long_matrix(m.start.q);
  const LongVec x = m.start.x.cast<long double>() + h * m.velocity.cast<long double>();
  return {LongVec(x + carrier * m.offset.x.cast<long double>()),
          LongMat(carrier * long_matrix(m.offset.q))};
}

/// Greatest gap of two boxes along their fifteen axes: positive only if they are apart, and no more
/// than their distance.
inline long double box_gap(const Vec3& half_a, const LongPose& a, const Vec3& half_b,
                           const LongPose& b) {
  const LongVec d = b.x - a.x;
  long double best = -1e30L;
  const auto along = [&](const LongVec& axis) {
    const long double length = axis.norm();
    if (length < 1e-9L) return;
    const long double reach = (a.R.transpose() * axis).cwiseAbs().dot(half_a.cast<long double>()) +
                              (b.R.transpose() * axis).cwiseAbs().dot(half_b.cast<long double>());
    best = std::max(best, (fabsl(axis.dot(d)) - reach) / length);
  };
  for (int i = 0; i < 3; ++i) {
    along(a.R.col(i));
    along(b.R.col(i));
    for (int j = 0; j < 3; ++j) along(a.R.col(i).cross(b.R.col(j)));
  }
  return best;
}

/// The first time in [t0, t1] at which `gap(t)` falls to zero, by dense samples and bisection; t1
/// and a second if it does not. Dips between samples are not seen.
template <class Gap>
long double first_zero(double t0, double t1, int samples, const Gap& gap) {
  long double before = t0;
  for (int k = 0; k <= samples; ++k) {
    const long double t = t0 + (static_cast<long double>(t1) - t0) * k / samples;
    if (gap(t) > 0) {
      before = t;
      continue;
    }
    long double low = before, high = t;
    for (int i = 0; i < 80; ++i) {
      const long double middle = (low + high) / 2;
      (gap(middle) > 0 ? low : high) = middle;
    }
    return high;
  }
  return static_cast<long double>(t1) + 1;
}

inline Motion motion_for(const Pose& pose, const Vec3& v, const Vec3& omega, double t1) {
  Motion m = Motion::at_rest(pose, 0, t1);
  m.velocity = v;
  m.omega = omega;
  return m;
}

}  // namespace tumble::test
