#pragma once
#include "engine/dynamics/joints/coordinate_drive.hpp"
#include "engine/dynamics/joints/joint_coordinate.hpp"
#include "engine/dynamics/joints/joint_part.hpp"

#include <string_view>
#include <vector>

namespace tumble {

/// Kinds of joints, by the relative motion that they leave (Coutinho 2013 §5.3). The order is that
/// of all_joint_kinds() and of numbers in snapshots.
enum class JointKind : uint8_t {
  spherical,    ///< all rotation about the anchor
  universal,    ///< rotation about z of A's frame and about x of B's, which stay perpendicular
  revolute,     ///< rotation about the z axis
  cylindrical,  ///< rotation about the z axis and sliding along it
  prismatic,    ///< sliding along the z axis of A's frame
  rigid,        ///< nothing
  distance,     ///< everything that keeps the distance of the anchors
  planar,       ///< sliding perpendicular to the z axis of A's frame, and rotation about it
  free,         ///< everything; forces act along the distance of the anchors
};

/// A kind of joint, made of parts.
struct JointKindEntry {
  std::string_view name;
  JointKind kind;
  std::vector<JointPart> parts;
  /// The motions that remain free; with the rows of the parts at most JointRows::most.
  std::vector<JointCoordinate> coordinates;
  bool uses_axes = true;  ///< false: the parts need only the anchors
  std::string_view doc;   ///< for lists of choices

  bool counts_turns() const {
    return !coordinates.empty() && kind != JointKind::spherical && coordinates.back().turns;
  }
};

/// "spherical", "universal", ... in the order of JointKind.
const std::vector<JointKindEntry>& all_joint_kinds();
inline const JointKindEntry& entry_of(JointKind kind) {
  return all_joint_kinds()[size_t(kind)];
}

/// Index of a coordinate by its name; coordinates.size() if there is none.
size_t coordinate_named(JointKind kind, std::string_view name);

}  // namespace tumble
