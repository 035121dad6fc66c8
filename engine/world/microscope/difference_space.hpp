#pragma once
#include "engine/collision/gjk/gjk.hpp"
#include "engine/world/microscope/microscope.hpp"

namespace tumble {

/// The pair of a slide as GJK sees it, and the way from its frames to the world: the bodies where
/// they are, the difference A - B beside them.
class DifferenceSpace {
 public:
  explicit DifferenceSpace(const MicroscopeSlide& slide);

  const PlacedCore& a() const { return A_; }
  const PlacedCore& b() const { return B_; }
  double rounding() const { return A_.core->rounding() + B_.core->rounding(); }
  /// The point of the difference furthest along a direction of A's own frame.
  DifferencePoint support(const Vec3& direction) const;

  Vec3 on_body(const Vec3& p) const { return origin_ + A_.R * p; }
  Vec3 beside(const Vec3& w) const { return beside_ + A_.R * w; }
  /// From the frame of the query, where PlacedCore puts things.
  Vec3 from_query(const Vec3& p) const { return origin_ + p; }
  Vec3 direction(const Vec3& d) const { return A_.R * d; }
  /// A length to draw planes and arrows by [m].
  double size() const { return size_; }

  /// Bodies in wires, the difference with its origin, names.
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
