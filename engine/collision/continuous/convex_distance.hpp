#pragma once
#include "engine/collision/continuous/moving_distance.hpp"
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/polyhedron_feature.hpp"

namespace tumble {

struct VoronoiPolyhedron;

/// Whether a frame is so far from its carrier's centre (ten times the radius) that speed bounds
/// about the centre are poor for points within `radius` of the frame. For nearer frames a better
/// bound costs more than the steps that it saves.
inline bool rides_far(const Motion& m, double radius) {
  return m.offset.x.norm() > 10 * radius;
}

/// A moving convex core.
struct MovingCore {
  const ConvexCore& core;
  const Motion& motion;
  double lever;  ///< largest distance of a point of the rounded core from the carrier's centre [m]
  /// Largest distance of a point of the core, without rounding, from the frame's origin [m].
  double radius;
  /// Voronoi planes of boxes and hulls, if V-Clip is to find the closest features; else null.
  const VoronoiPolyhedron* voronoi = nullptr;

  bool rides_far() const { return tumble::rides_far(motion, radius + core.rounding()); }
  /// Bound on the velocity along unit vector `n` of any of its points, at any time [m/s]. For a
  /// frame far from its carrier's centre, it is the orbital speed of the frame's origin, plus the
  /// rotation of the core about that origin.
  double speed_along(const Vec3& n) const;
};

/// Nearest points of two rounded cores at given poses, by GJK. The distance is the width of the gap
/// along the normal found, which is never too large; beyond `reach` it is some lower bound. The
/// distance of the points is within a tenth of `tolerance` of it. `direction`, if given, is the
/// initial search direction, and receives the normal found.
Nearest nearest_cores(const MovingCore& a, const Pose& pa, const MovingCore& b, const Pose& pb,
                      double reach, double tolerance, Vec3* direction = nullptr);

/// Distance of two rounded convex cores, by V-Clip when both have Voronoi planes, else by GJK; each
/// query starts where the last one ended.
class ConvexDistance final : public MovingDistance {
 public:
  ConvexDistance(const MovingCore& a, const MovingCore& b, double tolerance);
  Nearest at(double t, double reach) override;
  double approach(const Vec3& n) const override;
  /// For frames far from their carriers, the present velocity of the frame's origin with a bound on
  /// its acceleration may be sharper than bounds for the whole motion, since the carrier's velocity
  /// and its rotation may cancel.
  double open_for(const Vec3& n, double t, double gap) const override;

 private:
  Nearest by_v_clip(const Pose& pa, const Pose& pb);

  MovingCore core_a_, core_b_;
  double tolerance_;
  Vec3 direction_ = Vec3::Zero();
  ClosestFeatures features_;
  bool started_ = false;
};

/// Distance of the half-space y <= 0 of a moving frame (A) and a convex core: the height of the
/// core's lowest point.
class HalfSpaceDistance final : public MovingDistance {
 public:
  HalfSpaceDistance(const Motion& plane, const MovingCore& b);
  Nearest at(double t, double reach) override;
  double approach(const Vec3& n) const override;

 private:
  MovingCore core_;
};

}  // namespace tumble
