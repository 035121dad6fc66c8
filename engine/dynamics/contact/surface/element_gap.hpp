#pragma once
#include "engine/dynamics/contact/surface/surface_element.hpp"

namespace tumble {

/// A body's pose and velocity at one moment.
struct BodyMotion {
  Pose pose;
  /// Velocity of the centre of mass [m/s]; angular velocity [rad/s]; world axes.
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();
};

/// The gap of two surface elements, and where it is.
struct ElementPlace {
  double gap = 0;               ///< along the normal; negative is penetration [m]
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
  Vec3 x_world = Vec3::Zero();  ///< midway between the surfaces [m]
  /// False where the elements have no unique normal (parallel lines, coinciding points).
  bool regular = true;
};

/// The gap with the derivatives that contact forces need.
struct ElementGap : ElementPlace {
  double rate = 0;  ///< of the gap [m/s]
  /// Second derivative of the gap if neither body accelerated [m/s2] (Coutinho 2013 §10.3, §10.4;
  /// Baraff 1992): the gap's second derivative is normal.(a_B - a_A at the point) plus this.
  double bias = 0;
  /// Tangential part of the rate of change of the relative velocity at the travelling contact point
  /// if neither body accelerated [m/s2], world axes.
  Vec3 tangential_bias = Vec3::Zero();
};

/// Whether a gap of the two kinds is defined: all but planes with lines, cones or planes.
bool known_pair(ElementKind a, ElementKind b);

/// `towards_b` (world axes) is near the normal: it decides on which side of A's edge B is, which
/// two crossing edges leave open, and where on a rim the search for the nearest point starts.
ElementGap element_gap(const SurfaceElement& a, const BodyMotion& motion_a, const SurfaceElement& b,
                       const BodyMotion& motion_b, const Vec3& towards_b);
/// The place alone, bitwise the same, in a third of the time.
ElementPlace element_place(const SurfaceElement& a, const BodyMotion& motion_a,
                           const SurfaceElement& b, const BodyMotion& motion_b,
                           const Vec3& towards_b);

}  // namespace tumble
