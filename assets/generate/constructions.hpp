#pragma once
#include "assets/generate/builder.hpp"

namespace tumble::assets {

/// Where a cross-section stands: its origin and its two unit axes; u x w points along the path.
struct Station {
  Vec3 origin;  ///< [m]
  Vec3 u;
  Vec3 w;
};

/// Points of an arc of a circle, both ends included.
Loop2 arc(double centre_u, double centre_w, double radius, double from_angle, double to_angle,
          int segments);
/// Regular polygon (or circle), counter-clockwise, first corner at `first_angle` [rad].
Loop2 regular_polygon(double corner_radius, int corners, double first_angle = 0);
/// The loop moved inwards (counter-clockwise loop) by `distance` [m], corners mitred.
Loop2 inset(const Loop2& loop, double distance);

/// A horizontal loop at height y: u = x, w = -z, so counter-clockwise is as seen from above.
Loop3 at_height(const Loop2& loop, double y);

/// Walls through equally long loops, each counter-clockwise about the direction of travel.
void skin(Builder& builder, const std::vector<Loop3>& sections, bool closed_path);
/// Walls as above and a cap at either end.
void loft(Builder& builder, const std::vector<Loop3>& sections);
/// One cross-section (counter-clockwise) carried along the stations.
void sweep(Builder& builder, const Loop2& section, const std::vector<Station>& path,
           bool closed_path);
/// The profile (u = radius, w = height), counter-clockwise, turned about the y axis. An open one
/// begins and ends on the axis.
void revolve(Builder& builder, const Loop2& profile, int segments);
/// The region within `outer` and without the `holes` (all counter-clockwise from above), from y = 0
/// to `height` [m]; rim edges chamfered by `bevel` [m].
void extrude(Builder& builder, const Loop2& outer, const std::vector<Loop2>& holes, double height,
             double bevel);
/// A tube of round section about a closed curve, by its points and a fixed "up" for the frames,
/// which must never be parallel to the curve.
void closed_tube(Builder& builder, const Loop3& curve, double radius, int section_segments,
                 const Vec3& up);

}  // namespace tumble::assets
