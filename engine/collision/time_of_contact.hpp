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
  initially_overlapping,  ///< nearer than the tolerance at the start, and nothing else is hit
  max_iterations,         ///< apart until `time`; beyond that unknown
  invalid,                ///< refused: see time_of_contact()
};

std::string_view to_string(TimeOfContactStatus status);

/// When two moving shapes first come within the tolerance of each other, with the evidence.
struct TimeOfContact {
  TimeOfContactStatus status = TimeOfContactStatus::separated;
  double time = 0;           ///< of the contact, else the end of what is known [s]
  Vec3 on_a = Vec3::Zero();  ///< nearest points at `time`, world [m]
  Vec3 on_b = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
  /// The shapes are apart at `low` = `time`, by distance_low in (0, tolerance]; at `high` the
  /// distance is distance_high, 0 when they overlap by then (grazing contacts may not).
  double low = 0, high = 0;                    ///< [s]
  double distance_low = 0, distance_high = 0;  ///< [m]
  uint32_t triangle_a = 0, triangle_b = 0;     ///< that touch, of meshes
  int iterations = 0;                          ///< distance queries, or marches of triangle pairs
  /// What touches, on A and on B, when they do: see Shape::feature_at().
  ClosestFeatures features;
  /// Proven that nothing touches before `low`, rounding included. False for what is so far away or
  /// so large that a quarter of the tolerance is below the rounding of a pose, and when refused.
  bool certified = false;
  /// Name, in all_contact_time_methods(), of the method that answered; empty when refused.
  std::string_view method;

  bool hit() const { return status == TimeOfContactStatus::contact; }
};

struct MovingPair;

/// One way to find the time of contact.
struct ContactTimeMethod {
  std::string_view name;
  std::string_view description;
  /// Whether it can answer for this pair; A comes before B in the order half-space, convex, mesh.
  bool (*applies)(const MovingPair& pair);
  TimeOfContact (*find)(const MovingPair& pair);
};

/// "automatic" (the choice below), "bisection" (Coutinho 2013 §1.4.4, 1.4.6, 4.5, 4.7),
/// "conservative_advancement" (§1.4.7, 4.8, 13), "continuous_triangles" (§1.4.5, 4.6, 2.5.15),
/// "sphere_sphere" (§2.5.16) and "box_box" (§2.5.17). All but the first answer the same question
/// with the same guarantees, so that any may be forced; where one does not apply to a pair (a table
/// stands in continuous/README.md), the automatic choice answers.
const std::vector<ContactTimeMethod>& all_contact_time_methods();

struct TimeOfContactOptions {
  const ContactTimeMethod* method = nullptr;  ///< an entry of the list; null: automatic
  /// Distances of boxes and hulls by V-Clip, coherent from query to query, in place of GJK.
  bool v_clip = false;
};

/// First contact of two shapes that move as given over the same interval, rotation included.
///
/// Whatever the method: the answer is never past the contact; what comes within a quarter of the
/// tolerance is reported, what stays farther than the tolerance is not. Meshes, moving or not, are
/// surfaces, both sides of each triangle; triangles that are within the tolerance at the start are
/// left out, so that what rests on one part of a mesh is still stopped by another part.
/// Two half-spaces never touch.
///
/// `tolerance` > 0 [m]. Status `invalid`, and time t0, for a tolerance or a motion that is not
/// finite, a tolerance that is not positive, a quaternion that is not of unit length, or motions
/// over different or negative intervals.
TimeOfContact time_of_contact(const Shape& a, const Motion& motion_a, const Shape& b,
                              const Motion& motion_b, double tolerance,
                              const TimeOfContactOptions& options = {});

}  // namespace tumble
