#pragma once
#include "engine/collision/gjk/gjk.hpp"
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// The pair of a slide as GJK sees it, and the transforms from its frames to the world. The bodies
/// are drawn in place, the Minkowski difference A - B beside them.
class DifferenceSpace {
 public:
  explicit DifferenceSpace(const MicroscopeSlide& slide);

  const PlacedCore& a() const { return A_; }
  const PlacedCore& b() const { return B_; }
  double rounding() const { return A_.core->rounding() + B_.core->rounding(); }
  /// Support point of the difference in a direction given in A's frame.
  DifferencePoint support(const Vec3& direction) const;

  Vec3 on_body(const Vec3& p) const { return origin_ + A_.R * p; }
  Vec3 beside(const Vec3& w) const { return beside_ + A_.R * w; }
  /// World position of a point in the frame of the query, in which PlacedCore places shapes.
  Vec3 from_query(const Vec3& p) const { return origin_ + p; }
  Vec3 direction(const Vec3& d) const { return A_.R * d; }
  /// The length scale for drawing planes and arrows [m].
  double size() const { return size_; }

  /// Draws the bodies as wire frames, and the difference with its origin and labels.
  void draw(Sketch& out) const;

 private:
  void make_outline();

  const MicroscopeSlide& slide_;
  PlacedCore A_, B_;
  Vec3 origin_, beside_;
  double size_ = 1;
  Sketch outline_;  ///< of the difference
};

}  // namespace tumble
