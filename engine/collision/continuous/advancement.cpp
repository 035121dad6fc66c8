#include "engine/collision/continuous/advancement.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int max_steps = 1024;

/// Nearest points at one moment.
struct Nearest {
  double distance = 0;
  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero(), normal = Vec3::Zero();
};

/// The loop that both kinds share. `nearest(t, reach)` measures, and need not look beyond `reach`;
/// `approach(n, t)` bounds the closing speed along n from t on; `fastest` bounds it in any
/// direction.
template <class Measure, class Approach>
TimeOfContact run(double t0, double t1, double fastest, double tolerance, const Measure& nearest,
                  const Approach& approach, ContactTimeTrace* trace) {
  TimeOfContact r;
  r.low = r.time = t0;
  r.high = t1;
  const auto note = [&](double time, double low, const Nearest& n, double speed) {
    if (trace) trace->push_back({time, low, r.high, n.distance, n.on_a, n.on_b, n.normal, speed});
  };
  double t = t0;
  for (r.iterations = 1; r.iterations <= max_steps; ++r.iterations) {
    const Nearest now = nearest(t, fastest * (t1 - t) + 2 * tolerance);
    if (now.distance <= tolerance) {
      r.status = t > t0 ? TimeOfContactStatus::contact : TimeOfContactStatus::initially_overlapping;
      r.time = r.low = t;
      r.distance_low = now.distance;
      r.on_a = now.on_a, r.on_b = now.on_b, r.normal = now.normal;
      // one look ahead, to where a head-on contact would overlap
      const double speed = std::max(approach(now.normal, t), 1e-3 * fastest);
      note(t, t, now, speed);
      r.high = speed > 0 ? std::min(t1, t + 2 * now.distance / speed) : t1;
      const Nearest ahead = nearest(r.high, 4 * tolerance);
      note(r.high, t, ahead, 0);
      r.distance_high = ahead.distance;
      return r;
    }
    r.distance_low = now.distance;
    r.on_a = now.on_a, r.on_b = now.on_b, r.normal = now.normal;
    const double speed = approach(now.normal, t);
    note(t, t, now, speed);
    // aim for half the tolerance, so that rounding never carries the step past the contact
    const double step = speed > 0 ? (now.distance - 0.5 * tolerance) / speed : t1 - t;
    if (!(t + step < t1)) {
      r.status = TimeOfContactStatus::separated;
      r.time = r.low = t1;
      return r;
    }
    t += step;
    r.time = r.low = t;
  }
  r.status = TimeOfContactStatus::max_iterations;
  return r;
}

}  // namespace

TimeOfContact advance(const MovingCore& a, const MovingCore& b, double t0, double t1,
                      double tolerance, ContactTimeTrace* trace) {
  const double ra = a.core.rounding(), rb = b.core.rounding(), rounding = ra + rb;
  Vec3 direction = Vec3::Zero();
  const auto nearest = [&](double t, double reach) {
    const Pose pa = a.motion.pose(t), pb = b.motion.pose(t);
    GjkOptions options;
    options.max_distance = reach + rounding;
    options.relative_tolerance = 1e-6;  // the lower bound is what is used
    options.initial_direction = direction;
    const PlacedCore A(a.core, pa.q, Vec3::Zero()), B(b.core, pb.q, pb.x - pa.x);
    const GjkResult g = gjk(A, B, options);
    Nearest n;
    // the width of the gap along the normal that the step will be bounded along
    const double width = g.normal.dot(B.support(-g.normal) - A.support(g.normal));
    n.distance = std::max(0.0, width - rounding);
    n.normal = g.normal;
    n.on_a = pa.x + g.a + ra * g.normal;
    n.on_b = pa.x + g.b - rb * g.normal;
    direction = g.normal;
    return n;
  };
  const auto approach = [&](const Vec3& n, double) {
    return a.motion.speed_bound_along(n, a.lever) + b.motion.speed_bound_along(-n, b.lever);
  };
  const double fastest = a.motion.speed_bound(a.lever) + b.motion.speed_bound(b.lever);
  return run(t0, t1, fastest, tolerance, nearest, approach, trace);
}

TimeOfContact advance_half_space(const Motion& plane, const MovingCore& b, double t0, double t1,
                                 double tolerance, ContactTimeTrace* trace) {
  const auto nearest = [&](double t, double) {
    const Pose pa = plane.pose(t), pb = b.motion.pose(t);
    Nearest r;
    r.normal = pa.direction(Vec3::UnitY());
    const Vec3 p =
        pb.point(b.core.support(pb.inverse_direction(-r.normal))) - b.core.rounding() * r.normal;
    const double height = r.normal.dot(p - pa.x);
    r.distance = std::max(0.0, height);
    r.on_b = p;
    r.on_a = p - height * r.normal;
    return r;
  };
  // How far from the plane's carrier any point of B can ever be; the plane's own point beneath it
  // is no farther.
  const auto distance = [&](double t) {
    return (b.motion.carrier(t).x - plane.carrier(t).x).norm() + b.lever;
  };
  const double lever = std::max(distance(t0), distance(t1)) + plane.offset.x.norm();
  const double fastest = plane.speed_bound(lever) + b.motion.speed_bound(b.lever);
  const auto approach = [&](const Vec3& n, double) {
    if (!plane.omega.isZero()) return fastest;  // the normal turns, so no direction can be kept
    return plane.speed_bound_along(n, 0) + b.motion.speed_bound_along(-n, b.lever);
  };
  return run(t0, t1, fastest, tolerance, nearest, approach, trace);
}

}  // namespace tumble
