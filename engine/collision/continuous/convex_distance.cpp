#include "engine/collision/continuous/convex_distance.hpp"

#include "engine/collision/v_clip/v_clip.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// The distance is the width of the gap along the normal by which steps will be bounded.
Nearest gap_between(const Pose& pa, const PlacedCore& A, const PlacedCore& B, const Vec3& on_a,
                    const Vec3& on_b, const Vec3& normal) {
  const double ra = A.core->rounding(), rb = B.core->rounding();
  Nearest n;
  const double width = normal.dot(B.support(-normal) - A.support(normal));
  n.distance = std::max(0.0, width - (ra + rb));
  n.normal = normal;
  n.on_a = pa.x + on_a + ra * normal;
  n.on_b = pa.x + on_b - rb * normal;
  return n;
}

}  // namespace

double MovingCore::speed_along(const Vec3& n) const {
  if (!rides_far()) return motion.speed_bound_along(n, lever);
  const double spin = n.cross(motion.omega).norm();
  return n.dot(motion.velocity) + std::min(spin * lever, motion.orbit_speed() + spin * radius);
}

Nearest nearest_cores(const MovingCore& a, const Pose& pa, const MovingCore& b, const Pose& pb,
                      double reach, double tolerance, Vec3* direction) {
  GjkOptions options;
  const double rounding = a.core.rounding() + b.core.rounding();
  options.max_distance = reach + rounding;
  // The lower bound is what is used; of the cores' distance the rounding may be the most.
  options.relative_tolerance = 1e-6;
  if (0.1 * tolerance < 1e-6 * rounding) options.relative_tolerance = 0.1 * tolerance / rounding;
  if (direction) options.initial_direction = *direction;
  const PlacedCore A(a.core, pa.q, Vec3::Zero()), B(b.core, pb.q, pb.x - pa.x);
  const GjkResult g = gjk(A, B, options);
  if (direction) *direction = g.normal;
  return gap_between(pa, A, B, g.a, g.b, g.normal);
}

ConvexDistance::ConvexDistance(const MovingCore& a, const MovingCore& b, double tolerance)
    : MovingDistance(a.motion, b.motion), core_a_(a), core_b_(b), tolerance_(tolerance) {
  fastest_ = a.motion.speed_bound(a.lever) + b.motion.speed_bound(b.lever);
}

Nearest ConvexDistance::at(double t, double reach) {
  const Pose pa = a_.pose(t), pb = b_.pose(t);
  if (core_a_.voronoi && core_b_.voronoi) return by_v_clip(pa, pb);
  return nearest_cores(core_a_, pa, core_b_, pb, reach, tolerance_, &direction_);
}

Nearest ConvexDistance::by_v_clip(const Pose& pa, const Pose& pb) {
  const PlacedCore A(core_a_.core, pa.q, Vec3::Zero()), B(core_b_.core, pb.q, pb.x - pa.x);
  VClipOptions options;
  if (started_) options.start = &features_;
  const VClipResult v = v_clip({*core_a_.voronoi, A.R, A.x}, {*core_b_.voronoi, B.R, B.x}, options);
  features_ = v.features;
  started_ = true;
  return gap_between(pa, A, B, v.a, v.b, v.normal);
}

double ConvexDistance::approach(const Vec3& n) const {
  return core_a_.speed_along(n) + core_b_.speed_along(-n);
}

double ConvexDistance::open_for(const Vec3& n, double t, double gap) const {
  const double by_speed = MovingDistance::open_for(n, t, gap);
  if (!core_a_.rides_far() && !core_b_.rides_far()) return by_speed;
  // The gap decreases in a time s by at most u s + w s^2 / 2.
  const double u = n.dot(a_.origin_velocity(t) - b_.origin_velocity(t)) +
                   n.cross(a_.omega).norm() * core_a_.radius +
                   n.cross(b_.omega).norm() * core_b_.radius;
  const double w = a_.omega.norm() * a_.orbit_speed() + b_.omega.norm() * b_.orbit_speed();
  const double root = std::sqrt(u * u + 2 * w * std::max(gap, 0.0));
  if (u > 0) return std::max(by_speed, 2 * gap / (u + root));
  return w > 0 ? std::max(by_speed, (root - u) / w) : std::numeric_limits<double>::infinity();
}

HalfSpaceDistance::HalfSpaceDistance(const Motion& plane, const MovingCore& b)
    : MovingDistance(plane, b.motion), core_(b) {
  // Bound on the distance of any point of B from the plane's carrier; the point of the plane
  // beneath it is no farther away.
  const auto distance = [&](double t) {
    return (b_.carrier(t).x - a_.carrier(t).x).norm() + core_.lever;
  };
  const double lever = std::max(distance(a_.t0), distance(a_.t1)) + a_.offset.x.norm();
  fastest_ = a_.speed_bound(lever) + b_.speed_bound(core_.lever);
}

Nearest HalfSpaceDistance::at(double t, double) {
  const Pose pa = a_.pose(t), pb = b_.pose(t);
  Nearest r;
  r.normal = pa.direction(Vec3::UnitY());
  const Vec3 p = pb.point(core_.core.support(pb.inverse_direction(-r.normal))) -
                 core_.core.rounding() * r.normal;
  const double height = r.normal.dot(p - pa.x);
  r.distance = std::max(0.0, height);
  r.on_b = p;
  r.on_a = p - height * r.normal;
  return r;
}

double HalfSpaceDistance::approach(const Vec3& n) const {
  if (!a_.omega.isZero()) return fastest_;  // the normal rotates: no fixed direction
  return a_.speed_bound_along(n, 0) + b_.speed_bound_along(-n, core_.lever);
}

}  // namespace tumble
