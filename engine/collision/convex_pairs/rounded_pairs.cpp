#include "engine/collision/convex_pairs/rounded_pairs.hpp"

#include "engine/collision/convex_pairs/face_clipping.hpp"
#include "engine/collision/feature_key.hpp"
#include "engine/collision/gjk/minkowski.hpp"
#include "engine/collision/shapes/box.hpp"
#include "engine/collision/shapes/capsule.hpp"
#include "engine/collision/shapes/sphere.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr uint64_t centre_feature = feature_key(FeaturePair::closest, 0, 0);

/// One contact point between rounded cores whose nearest points are p (of A) and q (of B).
/// `fallback` is the normal if these coincide.
void point_contact(const ShapePair& pair, const Vec3& p, const Vec3& q, double ra, double rb,
                   const Vec3& fallback, std::vector<Manifold>& out) {
  const Vec3 d = q - p;
  const double distance = d.norm(), gap = distance - ra - rb;
  if (gap > pair.margin) return;
  const Vec3 n = distance > 1e-12 * (ra + rb) ? Vec3(d / distance) : fallback;
  ManifoldBuilder points;
  points.add(0.5 * (p + q) + 0.5 * (ra - rb) * n, gap, centre_feature);
  emit(pair, points, n, 0, out);
}

struct Axis {
  Vec3 p0, p1;
  Axis(const CapsuleShape& c, const Pose& pose)
      : p0(pose.point({0, -c.half_height(), 0})), p1(pose.point({0, c.half_height(), 0})) {}
  Vec3 direction() const { return p1 - p0; }
};

/// Some unit vector perpendicular to d.
Vec3 across(const Vec3& d) {
  int axis = 0;
  d.cwiseAbs().minCoeff(&axis);
  const Vec3 n = d.cross(Vec3::Unit(axis));
  return n.squaredNorm() > 0 ? Vec3(n.normalized()) : Vec3::UnitY();
}

}  // namespace

void collide_sphere_sphere(const ShapePair& pair, std::vector<Manifold>& out) {
  const auto& a = static_cast<const SphereShape&>(pair.a);
  const auto& b = static_cast<const SphereShape&>(pair.b);
  point_contact(pair, pair.pose_a.x, pair.pose_b.x, a.radius(), b.radius(), Vec3::UnitY(), out);
}

void collide_sphere_capsule(const ShapePair& pair, std::vector<Manifold>& out) {
  const auto& a = static_cast<const SphereShape&>(pair.a);
  const auto& b = static_cast<const CapsuleShape&>(pair.b);
  const Axis axis(b, pair.pose_b);
  const Vec3 q = closest_on_segment(pair.pose_a.x, axis.p0, axis.p1).point;
  point_contact(pair, pair.pose_a.x, q, a.radius(), b.radius(), across(axis.direction()), out);
}

void collide_capsule_capsule(const ShapePair& pair, std::vector<Manifold>& out) {
  const auto& a = static_cast<const CapsuleShape&>(pair.a);
  const auto& b = static_cast<const CapsuleShape&>(pair.b);
  const Axis s(a, pair.pose_a), t(b, pair.pose_b);
  const SegmentPair near = closest_segment_segment(s.p0, s.p1, t.p0, t.p1);
  const double ra = a.radius(), rb = b.radius();
  const double distance = std::sqrt(near.squared_distance);
  if (distance - ra - rb > pair.margin) return;
  Vec3 n = s.direction().cross(t.direction());
  n = n.squaredNorm() > 1e-16 ? Vec3(n.normalized()) : across(s.direction() + t.direction());
  if (distance > 1e-12 * (ra + rb)) n = (near.on_b - near.on_a) / distance;
  // Parallel axes: the two ends of the overlap.
  ManifoldBuilder points;
  SupportingFace fa, fb;
  for (uint32_t k = 0; k < 2; ++k) {
    fa.add(k ? s.p1 : s.p0, k);
    fb.add(k ? t.p1 : t.p0, k);
  }
  const double least = distance - ra - rb;
  if (n.cross(s.direction()).norm() > 0.9 * s.direction().norm())
    clip_faces(fa, fb, n, ra, rb, pair.margin, points);
  bool deep_enough = false;
  for (const ManifoldPoint& p : points.points())
    deep_enough = deep_enough || p.gap < least + 1e-3 * (ra + rb);
  if (points.count() < 2 || !deep_enough) {
    point_contact(pair, near.on_a, near.on_b, ra, rb, n, out);
    return;
  }
  emit(pair, points, n, 0, out);
}

void collide_sphere_box(const ShapePair& pair, std::vector<Manifold>& out) {
  const auto& a = static_cast<const SphereShape&>(pair.a);
  const auto& b = static_cast<const BoxShape&>(pair.b);
  const Vec3 h = b.half_extents();
  const Vec3 c = pair.pose_b.inverse_point(pair.pose_a.x);
  const Vec3 q = c.cwiseMax(-h).cwiseMin(h);
  const double distance = (c - q).norm();
  if (distance > 1e-12 * h.maxCoeff()) {
    point_contact(pair, pair.pose_a.x, pair.pose_b.point(q), a.radius(), 0, Vec3::UnitY(), out);
    return;
  }
  // The centre is inside: the normal is that of the nearest face.
  int axis = 0;
  const double depth = (h - c.cwiseAbs()).minCoeff(&axis);
  const Vec3 outward = (c[axis] < 0 ? -1.0 : 1.0) * Vec3::Unit(axis);
  const Vec3 n = -pair.pose_b.direction(outward);
  const double gap = -std::max(depth, 0.0) - a.radius();
  if (gap > pair.margin) return;
  ManifoldBuilder points;
  points.add(pair.pose_a.x + (a.radius() + 0.5 * gap) * n, gap, centre_feature);
  emit(pair, points, n, 0, out);
}

}  // namespace tumble
