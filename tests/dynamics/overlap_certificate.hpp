#pragma once
// How deep two convex bodies overlap, by support functions alone: the separation along any
// direction is a lower bound of the gap, so the best of several directions certifies it, wherever
// these come from.
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "tests/support/shape_reference.hpp"

#include <algorithm>
#include <limits>

namespace tumble::test {

inline double extent_along(const BodyShape& s, const Pose& body, const Vec3& n) {
  const Pose at = body * s.pose;
  return n.dot(at.x) + extent_along(s.shape->def(), at.inverse_direction(n));
}

/// Of the plane across n between A below and B above: positive when it separates them.
inline double separation(const RigidBody& a, const BodyShape& sa, const RigidBody& b,
                         const BodyShape& sb, const Vec3& n) {
  return -extent_along(sb, b.pose, -n) - extent_along(sa, a.pose, n);
}

/// A lower bound of the gap of two convex shapes or half-spaces, sharp where they are near.
inline double certified_gap(const RigidBody& a, const BodyShape& sa, const RigidBody& b,
                            const BodyShape& sb) {
  for (const BodyShape* s : {&sa, &sb}) {
    if (s->shape->type() != ShapeType::half_space) continue;
    const Vec3 up = ((s == &sa ? a : b).pose * s->pose).direction(Vec3::UnitY());
    return separation(a, sa, b, sb, s == &sa ? up : Vec3(-up));
  }
  double best = -std::numeric_limits<double>::infinity();
  const auto measure = [&](Vec3 n) {
    const Pose pa = a.pose * sa.pose, pb = b.pose * sb.pose;
    for (int k = 0; k < 6; ++k) {
      best = std::max(best, separation(a, sa, b, sb, n));
      // Moved apart along a direction the nearest points say the direction well.
      const Vec3 apart = (0.01 + std::max(0.0, -best)) * n;
      const GjkResult r = gjk(PlacedCore(*sa.shape->convex(), pa.q, Vec3::Zero()),
                              PlacedCore(*sb.shape->convex(), pb.q, pb.x - pa.x + apart));
      if (r.status != GjkStatus::separated) return;
      n = r.normal;
    }
    best = std::max(best, separation(a, sa, b, sb, n));
  };
  const double reach = sa.shape->bounding_radius() + sb.shape->bounding_radius();
  const Vec3 between = b.pose.point(sb.pose.x) - a.pose.point(sa.pose.x);
  if (between.norm() > reach) return between.norm() - reach;
  if (between.norm() > 0) measure(between.normalized());
  std::vector<Manifold> manifolds;
  collide(*sa.shape, a.pose * sa.pose, *sb.shape, b.pose * sb.pose, ContactQuery(0.01), manifolds);
  for (const Manifold& m : manifolds) measure(m.normal);
  return best;
}

/// The deepest overlap of any two bodies, zero when there is none [m].
inline double deepest_certified_overlap(const std::vector<RigidBody>& bodies) {
  double deepest = 0;
  for (size_t i = 0; i < bodies.size(); ++i)
    for (size_t j = i + 1; j < bodies.size(); ++j) {
      if (!bodies[i].dynamic() && !bodies[j].dynamic()) continue;
      for (const BodyShape& sa : bodies[i].shapes)
        for (const BodyShape& sb : bodies[j].shapes)
          deepest = std::max(deepest, -certified_gap(bodies[i], sa, bodies[j], sb));
    }
  return deepest;
}

}  // namespace tumble::test
