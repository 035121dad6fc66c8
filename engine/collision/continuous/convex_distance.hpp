#pragma once
#include "engine/collision/continuous/moving_distance.hpp"
#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/polyhedron_feature.hpp"

namespace tumble {

struct VoronoiPolyhedron;

/// Whether a frame rides so far from its carrier's centre that bounds about the centre say little
/// of what is within `radius` of it: by ten times that. Nearer, a better bound costs more than the
/// steps that it saves.
inline bool rides_far(const Motion& m, double radius) {
  return m.offset.x.norm() > 10 * radius;
}

/// A convex core on its way.
struct MovingCore {
  const ConvexCore& core;
  const Motion& motion;
  double lever;   ///< of the core with its rounding about the carrier's centre [m]
  double radius;  ///< of the core alone about the frame's origin: rounding does not turn [m]
  /// Of boxes and hulls, where their closest features are asked for by V-Clip; else null.
  const VoronoiPolyhedron* voronoi = nullptr;

  bool rides_far() const { return tumble::rides_far(motion, radius + core.rounding()); }
  /// Bound on the velocity along unit vector `n` of any of its points, at any time [m/s]. On a
  /// lever the frame's origin goes round at its own speed, and only what is around the origin turns
  /// besides.
  double speed_along(const Vec3& n) const;
};

/// Nearest points of two cores with their rounding at given poses, by GJK. The distance is the
/// width of the gap along the normal found, so that it errs on the safe side only; beyond `reach`
/// it is some lower bound. The points are within a tenth of `tolerance` of that distance.
/// `direction`, if any, is where to begin, and then the normal found.
Nearest nearest_cores(const MovingCore& a, const Pose& pa, const MovingCore& b, const Pose& pb,
                      double reach, double tolerance, Vec3* direction = nullptr);

/// Two convex cores with their rounding. By V-Clip when both have Voronoi planes, else by GJK; each
/// query starts where the last one ended.
class ConvexDistance final : public MovingDistance {
 public:
  ConvexDistance(const MovingCore& a, const MovingCore& b, double tolerance);
  Nearest at(double t, double reach) override;
  double approach(const Vec3& n) const override;
  /// On a lever the velocity of the frame's origin now, with a bound on its acceleration, may say
  /// more than bounds for the whole motion: the carrier's velocity and the turning may cancel.
  double open_for(const Vec3& n, double t, double gap) const override;

 private:
  Nearest by_v_clip(const Pose& pa, const Pose& pb);

  MovingCore core_a_, core_b_;
  double tolerance_;
  Vec3 direction_ = Vec3::Zero();
  ClosestFeatures features_;
  bool started_ = false;
};

/// The half-space y <= 0 of a moving frame (A) and a convex core: no point is below the lowest.
class HalfSpaceDistance final : public MovingDistance {
 public:
  HalfSpaceDistance(const Motion& plane, const MovingCore& b);
  Nearest at(double t, double reach) override;
  double approach(const Vec3& n) const override;

 private:
  MovingCore core_;
};

}  // namespace tumble
