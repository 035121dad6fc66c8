#pragma once
#include "engine/dynamics/contact/surface/surface_element.hpp"

namespace tumble {

/// A body's motion at one moment.
struct BodyMotion {
  Pose pose;
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();  ///< of the centre; world axes
};

/// The gap between two surface elements, and where it is.
struct ElementPlace {
  double gap = 0;               ///< along the normal; negative is penetration [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
  Vec3 x_world = Vec3::Zero();  ///< midway between the surfaces [m]
  bool regular = true;  ///< false where the elements have no gap (parallel lines, equal points)
};

/// The same with all that contact forces need of it.
struct ElementGap : ElementPlace {
  double rate = 0;  ///< of the gap [m/s]
  /// Second derivative of the gap if no acceleration acted on either body [m/s2] (Coutinho 2013
  /// §10.3, §10.4; Baraff 1992): the gap's acceleration is normal.(a_B - a_A at the point) plus
  /// this.
  double bias = 0;
  /// The tangential part of how fast the relative velocity at the travelling contact point would
  /// change if no acceleration acted [m/s2], world axes.
  Vec3 tangential_bias = Vec3::Zero();
};

/// Whether the two have a gap of their own: all but planes with lines, cones or planes.
bool known_pair(ElementKind a, ElementKind b);

/// `towards_b` (world axes) is near the normal: it says on which side of A's edge B is, which edges
/// that cross do not know, and where on a rim the nearest point is sought.
ElementGap element_gap(const SurfaceElement& a, const BodyMotion& motion_a, const SurfaceElement& b,
                       const BodyMotion& motion_b, const Vec3& towards_b);
/// Its place, to the same bits, in a third of the time.
ElementPlace element_place(const SurfaceElement& a, const BodyMotion& motion_a,
                           const SurfaceElement& b, const BodyMotion& motion_b,
                           const Vec3& towards_b);

}  // namespace tumble
