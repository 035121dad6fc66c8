#pragma once
#include "engine/collision/motion.hpp"
#include "engine/collision/shape.hpp"

#include <cstdint>
#include <string_view>

namespace tumble {

enum class TimeOfContactStatus {
  separated,              ///< no contact during the motion
  contact,                ///< at `time`, the first
  initially_overlapping,  ///< nearer than the tolerance at the start, and nothing else is hit
  max_iterations,         ///< apart until `time`; beyond that unknown
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
  int iterations = 0;                          ///< distance queries

  bool hit() const { return status == TimeOfContactStatus::contact; }
};

/// First contact of two shapes that move as given over the same interval, rotation included.
/// Conservative advancement (Mirtich 1996; Coutinho §13): steps are no longer than the distance
/// divided by a bound on the approach speed along the closest direction, so that the answer is
/// never past the contact. Meshes, moving or not, are tested triangle by triangle over the swept
/// hierarchy, both sides of each; triangles that are within the tolerance at the start are left
/// out, so that what rests on one part of a mesh is still stopped by another part.
/// Two half-spaces never touch. `tolerance` > 0 [m].
TimeOfContact time_of_contact(const Shape& a, const Motion& motion_a, const Shape& b,
                              const Motion& motion_b, double tolerance);

}  // namespace tumble
