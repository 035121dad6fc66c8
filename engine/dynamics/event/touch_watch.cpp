#include "engine/dynamics/event/touch_watch.hpp"

#include "engine/dynamics/event/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

Vec3 swing_of(const RigidBody& b) {
  if (b.shapes.size() != 1) return b.omega;
  const BodyShape& s = b.shapes[0];
  if (s.shape->is_ball() && s.pose.x.isZero(0)) return Vec3::Zero();
  const Vec3 axis = s.pose.direction(Vec3::UnitY());
  const bool round = s.shape->symmetry() == ShapeSymmetry::axis;
  if (!round || s.pose.x.cross(axis).norm() > tolerances::round_axis_of_radius * b.bounding_radius)
    return b.omega;
  const Vec3 u = b.pose.direction(axis);
  return b.omega - u.dot(b.omega) * u;
}

/// Bounds on speed and acceleration of points by the rotation of one body.
struct SwingBounds {
  double speed, bend;
  SwingBounds(const SwingMotion& t0, const SwingMotion& t1, double step) {
    const double most = tolerances::swing_spare * std::max(t0.swing.norm(), t1.swing.norm());
    const double r = std::max(t0.lever, t1.lever);
    speed = r * most;
    bend = r * (most * most + 2 * (t1.swing - t0.swing).norm() / step);
  }
};

}  // namespace

SwingMotion::SwingMotion(const RigidBody& b) : v(b.v), swing(swing_of(b)) {
  if (!swing.isZero(0)) lever = b.bounding_radius;
}

RelativeMotion::RelativeMotion(const SwingMotion& a_t0, const SwingMotion& b_t0,
                               const SwingMotion& a_t1, const SwingMotion& b_t1, double step) {
  const Vec3 v0 = b_t0.v - a_t0.v, v1 = b_t1.v - a_t1.v;
  const SwingBounds a(a_t0, a_t1, step), b(b_t0, b_t1, step);
  const double gain = 2 * (v1 - v0).norm();
  speed = std::max(v0.norm(), v1.norm()) + gain + a.speed + b.speed;
  bend = gain / step + a.bend + b.bend;
}

TouchWatch::TouchWatch(const EventPair& pair, const PiecePair& pieces,
                       std::span<const RigidBody> bodies, std::span<const Vec3> hints, double reach)
    : pair_(&pair), pieces_(pieces) {
  const RigidBody &a = bodies[pair.a.body], &b = bodies[pair.b.body];
  double gap = -std::numeric_limits<double>::infinity();
  Vec3 normal = Vec3::Zero();
  for (const Vec3& n : hints) {
    const double apart = separation(bodies, n);
    if (apart > gap) gap = apart, normal = n;
    near_ = near_ && apart <= reach;
  }
  if (!near_) return;
  if (!(gap > -tolerances::seen_depth)) {
    const PairGap g = gap_of_pieces(pair, pieces, bodies, reach, normal);
    near_ = g.near;
    if (g.near && g.gap > gap) gap = g.gap, normal = g.normal;
  }
  const double size = std::min(a.bounding_radius, b.bounding_radius);
  dip_ = std::min(tolerances::deepest_dip, tolerances::dip_of_size * size);
  const double depth = std::max(0.0, -tolerances::seen_depth - gap);
  // Pieces that overlap may do so as deep as was accepted.
  allowed_ = tolerances::deepest_unseen + (depth > 0 ? std::max(depth, pair.offset) : 0);
  passed_ = last_ = {a.pose, b.pose, normal, gap + allowed_};
}

double TouchWatch::separation(std::span<const RigidBody> bodies, const Vec3& n) const {
  return separation_of_pieces(*pair_, pieces_, bodies, n);
}

double TouchWatch::room_now(std::span<const RigidBody> bodies) const {
  const Vec3& n = last_.normal;
  const double gap =
      gap_of_pieces(*pair_, pieces_, bodies, std::numeric_limits<double>::max(), n).gap;
  return std::max(gap, separation(bodies, n)) + allowed_;
}

TouchWatch::Look TouchWatch::look(std::span<const RigidBody> bodies, double since) {
  const Pose &a = bodies[pair_->a.body].pose, &b = bodies[pair_->b.body].pose;
  const Vec3& n0 = passed_.normal;
  last_ = {a, b, n0, separation(bodies, n0) + allowed_};
  // Most often the normal is that of a face of one of the two: try it as it turns with either body.
  for (const auto& [then, now] : {std::pair(&passed_.a, &a), std::pair(&passed_.b, &b)}) {
    if (last_.room > 0) break;
    const Vec3 carried = now->direction(then->inverse_direction(n0));
    const double room = separation(bodies, carried) + allowed_;
    if (room > last_.room) last_.normal = carried, last_.room = room;
  }
  if (!(last_.room > 0)) {
    const PairGap g =
        gap_of_pieces(*pair_, pieces_, bodies, std::numeric_limits<double>::max(), last_.normal);
    if (g.near && g.gap + allowed_ > last_.room)
      last_.normal = g.normal, last_.room = g.gap + allowed_;
  }
  const double turned = (last_.normal - n0).norm();
  const double dip = (motion_.bend * since + 2 * turned * motion_.speed) * since / 8;
  if (!(std::min(passed_.room, std::max(0.0, last_.room)) - dip >= -dip_)) return Look::open;
  return last_.room > 0 ? Look::clear : Look::touched;
}

}  // namespace tumble
