#include "engine/collision/convex_pairs/capsule_box.hpp"

#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/shapes/box.hpp"
#include "engine/collision/shapes/capsule.hpp"

#include <cmath>

namespace tumble {

SegmentBoxDistance nearest_segment_box(const Vec3& p0, const Vec3& p1, const Vec3& h) {
  const Vec3 d = p1 - p0;
  const auto outside = [&](double t) -> Vec3 {
    const Vec3 p = p0 + t * d;
    return p - p.cwiseMax(-h).cwiseMin(h);
  };
  const auto slope = [&](double t) { return d.dot(outside(t)); };  // half of the derivative
  double low = 0, high = 1, at_low = slope(0);
  double t = 0;
  if (at_low < 0) {
    double at_high = slope(1);
    for (int k = 0; k < 6 && at_high > 0; ++k) {
      const int axis = k / 2;
      const double crossing = ((k % 2 ? h : -h)[axis] - p0[axis]) / d[axis];
      if (!(crossing > low && crossing < high)) continue;
      const double there = slope(crossing);
      (there < 0 ? low : high) = crossing;
      (there < 0 ? at_low : at_high) = there;
    }
    t = at_high > 0 ? low + (high - low) * (at_low / (at_low - at_high)) : high;
  }
  const Vec3 p = p0 + t * d;
  SegmentBoxDistance out;
  out.t = t;
  out.on_box = p.cwiseMax(-h).cwiseMin(h);
  out.between = p - out.on_box;
  return out;
}

void collide_capsule_box(const ShapePair& pair, std::vector<Manifold>& out) {
  const auto& capsule = static_cast<const CapsuleShape&>(pair.a);
  const auto& box = static_cast<const BoxShape&>(pair.b);
  const Mat3 axes = pair.pose_b.q.toRotationMatrix();
  const Vec3 centre = axes.transpose() * (pair.pose_a.x - pair.pose_b.x);
  const Vec3 along =
      axes.transpose() * pair.pose_a.direction(Vec3::UnitY()) * capsule.half_height();
  const Vec3& h = box.half_extents();
  const SegmentBoxDistance near = nearest_segment_box(centre - along, centre + along, h);
  const double distance = near.between.norm(), scale = h.norm() + capsule.half_height();
  if (distance < 1e-6 * scale) return collide_convex_convex(pair, out);
  const double gap = distance - capsule.radius();
  if (gap > pair.margin) {
    pair.found_apart(gap, scale + centre.norm());
    return;
  }
  CoreContact contact;
  contact.normal = axes * (near.between / -distance);
  contact.gap = gap;
  contact.b = pair.pose_b.x + axes * near.on_box;
  contact.a = contact.b - distance * contact.normal;
  const PlacedCore A(*capsule.convex(), pair.pose_a.q, pair.pose_a.x);
  const PlacedCore B(*box.convex(), axes, pair.pose_b.x);
  ManifoldBuilder points;
  contact_points(A, B, contact, pair.margin, points);
  emit(pair, points, contact.normal, 0, out);
}

}  // namespace tumble
