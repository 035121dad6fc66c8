#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/collision/shape.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tumble {

enum class TimeOfContactStatus {
  separated,              ///< no contact during the motion
  contact,                ///< at `time`, the first
  initially_overlapping,  ///< within the tolerance at the start, and nothing else is hit
  max_iterations,         ///< apart until `time`; beyond that unknown
  invalid,                ///< refused: see time_of_contact()
};

std::string_view to_string(TimeOfContactStatus status);

/// The first time at which two moving shapes come within the tolerance of each other, with the
/// evidence.
struct TimeOfContact {
  TimeOfContactStatus status = TimeOfContactStatus::separated;
  double time = 0;           ///< time of the contact, else the end of the examined time [s]
  Vec3 on_a = Vec3::Zero();  ///< nearest points at `time`, world [m]
  Vec3 on_b = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
  /// The shapes are apart at `low` = `time`, by distance_low in (0, tolerance]; at `high` the
  /// distance is distance_high, 0 if they overlap by then (in a grazing contact they may not).
  double low = 0, high = 0;                    ///< [s]
  double distance_low = 0, distance_high = 0;  ///< [m]
  uint32_t triangle_a = 0, triangle_b = 0;     ///< that touch, of meshes
  int iterations = 0;                          ///< distance queries, or steps of triangle pairs
  /// The features of A and B that touch, if they do: see Shape::feature_at().
  ClosestFeatures features;
  /// It is proven that nothing touches before `low`, rounding included. False for shapes so far
  /// away or so large that a quarter of the tolerance is below the rounding of a pose, and for
  /// invalid input.
  bool certified = false;
  /// Name, in all_contact_time_methods(), of the method that gave the result; empty for invalid
  /// input.
  std::string_view method;

  bool hit() const { return status == TimeOfContactStatus::contact; }
};

struct MovingPair;

/// One way to find the time of contact.
struct ContactTimeMethod {
  std::string_view name;
  std::string_view description;
  /// Whether it applies to this pair; A comes before B in the order half-space, convex, mesh.
  bool (*applies)(const MovingPair& pair);
  TimeOfContact (*find)(const MovingPair& pair);
};

/// "automatic" (the choice below), "bisection" (Coutinho 2013 §1.4.4, 1.4.6, 4.5, 4.7),
/// "conservative_advancement" (§1.4.7, 4.8, 13), "continuous_triangles" (§1.4.5, 4.6, 2.5.15),
/// "sphere_sphere" (§2.5.16) and "box_box" (§2.5.17). All but the first compute the same result
/// with the same guarantees, so that any may be chosen; if one does not apply to a pair (see the
/// table in continuous/README.md), the automatic choice is used.
const std::vector<ContactTimeMethod>& all_contact_time_methods();

struct TimeOfContactOptions {
  const ContactTimeMethod* method = nullptr;  ///< an entry of the list; null: automatic
  /// Distances of boxes and hulls by V-Clip, each query starting from the last features, instead of
  /// GJK.
  bool v_clip = false;
};

/// First contact of two shapes with given motions over the same interval, rotation included.
///
/// For every method: the result is never later than the contact; shapes that come within a quarter
/// of the tolerance are reported, shapes that stay farther than the tolerance are not. Meshes,
/// moving or not, are surfaces with two sides; pairs of triangles that are within the tolerance at
/// the start are left out, so that a shape that rests on one part of a mesh is still stopped by
/// another part.
/// Two half-spaces never touch.
///
/// `tolerance` > 0 [m]. Status `invalid`, and time t0, for a tolerance or a motion that is not
/// finite, a tolerance that is not positive, a quaternion that is not of unit length, or motions
/// over different or negative intervals.
TimeOfContact time_of_contact(const Shape& a, const Motion& motion_a, const Shape& b,
                              const Motion& motion_b, double tolerance,
                              const TimeOfContactOptions& options = {});

}  // namespace tumble
