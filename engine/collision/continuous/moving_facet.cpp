#include "engine/collision/continuous/moving_facet.hpp"

#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/continuous_tests/edge_edge.hpp"
#include "engine/geometry/continuous_tests/triangle_triangle.hpp"
#include "engine/geometry/continuous_tests/vertex_face.hpp"
#include "engine/math/rotation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

constexpr int most_facet_steps = 2048;

/// Keeps the earlier of two contacts, either of which may not exist.
void keep_first(std::optional<MovingContact>& best,
                const Result<std::optional<MovingContact>>& found) {
  if (found && *found && (!best || (*found)->t_lo < best->t_lo)) best = *found;
}

/// The steps for a facet (A) and a triangle (B), in a frame that translates with A's carrier.
class FacetMarch {
 public:
  FacetMarch(const MovingFacet& a, const MovingFacet& b) : a_(a), b_(b) {
    apart_ = b.motion->start.x - a.motion->start.x;
    velocity_ = b.motion->velocity - a.motion->velocity;
    acceleration_ = a.acceleration() + b.acceleration();
    turning_ = a.turning() + b.turning();
  }

  TimeOfContact run(double t0, double t1, double tolerance) const {
    TimeOfContact r;
    r.high = t1;
    double t = t0;
    const double target = 0.5 * tolerance;
    for (r.iterations = 1; r.iterations <= most_facet_steps; ++r.iterations) {
      const ClosestPair near = set_nearest_facets(r, t);
      if (r.distance_low <= tolerance) {
        return touching(
            r, near,
            t > t0 ? TimeOfContactStatus::contact : TimeOfContactStatus::initially_overlapping);
      }
      const double room = r.distance_low - target;
      const double speed = turning_ - r.normal.dot(velocity_);
      if (!(speed * (t1 - t) > room)) return separated(r, t1);
      // Steps that are safe by a bound on the speed suffice for most pairs that do not meet.
      if (r.iterations % 4 != 0) {
        const double safe = t + room / speed;
        if (!(safe > t)) break;  // the tolerance is below what time resolves
        t = safe;
        continue;
      }
      // The deviation from the chords, acceleration h^2 / 8, is to be small relative to the gap or
      // the tolerance.
      const double allowed = std::max(0.0625 * room, 0.125 * tolerance);
      double h = acceleration_ > 0 ? std::sqrt(8 * allowed / acceleration_) : t1 - t;
      const double end = h < t1 - t ? t + h : t1;
      h = end - t;
      if (!(h > 0)) break;  // the tolerance is below what time resolves
      const double departure = 0.125 * acceleration_ * h * h * (1 + 0x1p-40);
      const auto met = met_between(t, end, target + departure);
      if (!met) {
        if (!(end < t1)) return separated(r, t1);
        t = end;
        continue;
      }
      const double until = std::max(t, std::nextafter(t + met->t_lo * h, t));
      // A test that gave up without progress is followed by a step that is safe by the speed bound.
      t = until > t ? until : t + room / speed;
    }
    r.status = TimeOfContactStatus::max_iterations;
    return r;
  }

  double apart_until(double t, double tolerance) const {
    TimeOfContact r;
    set_nearest_facets(r, t);
    const double room = r.distance_low - 0.5 * tolerance;
    const double speed = turning_ - r.normal.dot(velocity_);
    if (r.distance_low <= tolerance) return t;
    return speed > 0 ? t + room / speed : std::numeric_limits<double>::infinity();
  }
  double distance(double t) const {
    return std::max(0.0, std::sqrt(closest(t).squared_distance) - rounding());
  }

 private:
  using Corners = std::array<Vec3, 3>;

  double rounding() const { return a_.rounding + b_.rounding; }
  static Corners turned(const MovingFacet& f, double t) {
    const Quat q = integrate_rotation(Quat::Identity(), f.motion->omega, t - f.motion->t0);
    const Mat3 R = q.toRotationMatrix();
    return {R * f.corner[0], R * f.corner[1], R * f.corner[2]};
  }
  Corners corners_a(double t) const { return turned(a_, t); }
  Corners corners_b(double t) const {
    Corners c = turned(b_, t);
    const Vec3 x = apart_ + (t - b_.motion->t0) * velocity_;
    for (Vec3& p : c) p += x;
    return c;
  }
  ClosestPair closest(double t) const {
    const Corners a = corners_a(t), b = corners_b(t);
    if (a_.corners == 3) return closest_triangle_triangle(a, b);
    if (a_.corners == 2) return closest_segment_triangle(a[0], a[1], b);
    const TrianglePoint p = closest_on_triangle(a[0], b[0], b[1], b[2]);
    return {a[0], p.point, p.squared_distance};
  }
  ClosestPair set_nearest_facets(TimeOfContact& r, double t) const {
    const ClosestPair near = closest(t);
    const double distance = std::sqrt(near.squared_distance);
    r.time = r.low = t;
    r.distance_low = std::max(0.0, distance - rounding());
    r.normal = distance > 0 ? Vec3((near.on_b - near.on_a) / distance) : Vec3(Vec3::Zero());
    const Vec3 origin = a_.motion->start.x + (t - a_.motion->t0) * a_.motion->velocity;
    r.on_a = origin + near.on_a + a_.rounding * r.normal;
    r.on_b = origin + near.on_b - b_.rounding * r.normal;
    return near;
  }
  TimeOfContact touching(TimeOfContact r, const ClosestPair& near,
                         TimeOfContactStatus status) const {
    r.status = status;
    const auto velocity = [](const MovingFacet& f, const Vec3& arm) {
      return Vec3(f.motion->velocity + f.motion->omega.cross(arm));
    };
    const Vec3 x = apart_ + (r.time - b_.motion->t0) * velocity_;
    const double closing = r.normal.dot(velocity(a_, near.on_a) - velocity(b_, near.on_b - x));
    const double fastest = turning_ + velocity_.norm();
    const double speed = std::max(closing, 1e-3 * fastest);
    if (speed > 0) r.high = std::min(r.high, r.time + 2 * r.distance_low / speed);
    r.distance_high = distance(r.high);
    return r;
  }
  static TimeOfContact separated(TimeOfContact r, double t1) {
    r.status = TimeOfContactStatus::separated;
    r.time = r.low = r.high = t1;
    return r;
  }
  std::optional<MovingContact> met_between(double from, double to, double separation) const {
    const Corners a0 = corners_a(from), a1 = corners_a(to);
    const Corners b0 = corners_b(from), b1 = corners_b(to);
    MovingTriangle a, b;
    for (size_t k = 0; k < 3; ++k) a[k] = {a0[k], a1[k]}, b[k] = {b0[k], b1[k]};
    const double s = separation + rounding();
    std::optional<MovingContact> best;
    if (a_.corners == 3) {
      const auto found = moving_triangles_contact(a, b, s);
      if (found && *found) best = **found;
      return best;
    }
    for (size_t i = 0; i < size_t(a_.corners); ++i)
      keep_first(best, vertex_face_contact(a[i], b, s));
    for (size_t j = 0; a_.corners == 2 && j < 3; ++j) {
      keep_first(best, edge_edge_contact({a[0], a[1]}, {b[j], b[(j + 1) % 3]}, s));
    }
    return best;
  }

  const MovingFacet &a_, &b_;
  Vec3 apart_, velocity_;  ///< of the carriers, B relative to A
  double acceleration_, turning_;
};

}  // namespace

MovingFacet::MovingFacet(const Motion& m, const std::array<Vec3, 3>& points, int count,
                         double radius)
    : corners(count), rounding(radius), motion(&m) {
  for (size_t k = 0; k < 3; ++k) {
    corner[k] = m.start.direction(m.offset.point(points[k < size_t(count) ? k : 0]));
  }
}

double MovingFacet::turning() const {
  double most = 0;
  for (const Vec3& p : corner) most = std::max(most, motion->omega.cross(p).squaredNorm());
  return std::sqrt(most) * (1 + 0x1p-40);
}

double MovingFacet::acceleration() const {
  return motion->omega.norm() * turning() * (1 + 0x1p-40);
}

TimeOfContact facet_contact(const MovingFacet& a, const MovingFacet& b, double t0, double t1,
                            double tolerance) {
  return FacetMarch(a, b).run(t0, t1, tolerance);
}

double facets_apart_until(const MovingFacet& a, const MovingFacet& b, double t, double tolerance) {
  return FacetMarch(a, b).apart_until(t, tolerance);
}

}  // namespace tumble
