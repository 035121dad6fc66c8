#include "engine/collision/continuous/closed_forms.hpp"

#include "engine/collision/continuous/contact_answer.hpp"
#include "engine/collision/continuous/moving_boxes.hpp"
#include "engine/geometry/continuous_tests/sphere_sphere.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

bool travels_straight(const Motion& m) {
  return m.omega.cross(m.start.direction(m.offset.x)).isZero(0);
}

/// The distance of two balls.
class BallDistance final : public MovingDistance {
 public:
  explicit BallDistance(const MovingPair& p)
      : MovingDistance(p.motion_a, p.motion_b),
        ra_(p.a.bounding_radius()),
        rb_(p.b.bounding_radius()) {
    fastest_ = (p.motion_a.velocity - p.motion_b.velocity).norm();
  }
  Nearest at(double t, double) override {
    const Vec3 xa = a_.pose(t).x, between = b_.pose(t).x - xa;
    const double distance = between.norm();
    Nearest n;
    n.distance = std::max(0.0, distance - (ra_ + rb_));
    if (distance > 0) n.normal = between / distance;
    n.on_a = xa + ra_ * n.normal;
    n.on_b = xa + between - rb_ * n.normal;
    return n;
  }
  double approach(const Vec3& n) const override { return n.dot(a_.velocity - b_.velocity); }

 private:
  double ra_, rb_;
};

/// The result for contact at `time`, completed by the distance at that time.
TimeOfContact contact_found(MovingDistance& distance, double time, const MovingPair& p) {
  TimeOfContact r;
  r.iterations = 2;
  const Nearest now = distance.at(time, 2 * p.tolerance);
  const bool near = now.distance <= p.tolerance;
  r.status = near ? TimeOfContactStatus::contact : TimeOfContactStatus::max_iterations;
  set_contact(r, distance, now, time, p.t1(), p.tolerance);
  return r;
}

TimeOfContact none_found(const MovingPair& p) {
  TimeOfContact r = separated_until(p.t1());
  r.iterations = 1;
  return r;
}

/// Whether they touch at the start, by the same criterion as for all methods.
bool touching_at_start(MovingDistance& distance, const MovingPair& p, TimeOfContact& r) {
  const Nearest now = distance.at(p.t0(), 2 * p.tolerance);
  if (now.distance > p.tolerance) return false;
  r.status = TimeOfContactStatus::initially_overlapping;
  r.iterations = 1;
  set_contact(r, distance, now, p.t0(), p.t1(), p.tolerance);
  return true;
}

}  // namespace

bool balls_apply(const MovingPair& p) {
  return p.a.is_ball() && p.b.is_ball() && travels_straight(p.motion_a) &&
         travels_straight(p.motion_b);
}

TimeOfContact find_by_balls(const MovingPair& p) {
  BallDistance distance(p);
  TimeOfContact r;
  if (touching_at_start(distance, p, r)) return r;
  const double duration = p.t1() - p.t0();
  // In a frame that translates with A.
  const Vec3 apart = p.motion_b.pose(p.t0()).x - p.motion_a.pose(p.t0()).x;
  const Vec3 way = duration * (p.motion_b.velocity - p.motion_a.velocity);
  const MovingSphere a{{Vec3::Zero(), Vec3::Zero()}, p.a.bounding_radius() + 0.5 * p.tolerance};
  const MovingSphere b{{apart, apart + way}, p.b.bounding_radius()};
  const auto met = moving_spheres_contact(a, b);
  if (!met || !*met) return none_found(p);
  return contact_found(distance, std::min(p.t1(), p.t0() + (*met)->t_lo * duration), p);
}

bool boxes_apply(const MovingPair& p) {
  const auto box = [](const Shape& s) {
    const ConvexShape* c = s.convex();
    return c && c->view().kind == CoreView::Kind::box && c->rounding() == 0;
  };
  return box(p.a) && box(p.b);
}

TimeOfContact find_by_boxes(const MovingPair& p) {
  ConvexDistance distance(p.core_a(), p.core_b(), p.tolerance);
  TimeOfContact r;
  if (touching_at_start(distance, p, r)) return r;
  const Vec3 rim = Vec3::Constant(0.125 * p.tolerance);
  const MovingBox a{p.a.convex()->view().half + rim, p.motion_a};
  const MovingBox b{p.b.convex()->view().half + rim, p.motion_b};
  const auto met = moving_boxes_contact(a, b);
  if (!met || !*met) return none_found(p);
  return contact_found(distance, (*met)->t_lo, p);
}

}  // namespace tumble
