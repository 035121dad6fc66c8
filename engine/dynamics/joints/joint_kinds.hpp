#pragma once
#include "engine/dynamics/joints/coordinate_drive.hpp"
#include "engine/dynamics/joints/joint_coordinate.hpp"
#include "engine/dynamics/joints/joint_part.hpp"

#include <string_view>
#include <vector>

namespace tumble {

/// Which relative motion a joint leaves (Coutinho 2013 §5.3). The order is that of
/// all_joint_kinds() and of the bytes in snapshots.
enum class JointKind : uint8_t {
  spherical,    ///< all rotation about the anchor
  universal,    ///< rotation about z of A's frame and about x of B's, which stay at right angles
  revolute,     ///< rotation about the z axis
  cylindrical,  ///< rotation about the z axis and sliding along it
  prismatic,    ///< sliding along the z axis of A's frame
  rigid,        ///< nothing
  distance,     ///< everything but the distance of the anchors
  planar,       ///< sliding across the z axis of A's frame and rotation about it
  free,         ///< everything; what acts, acts along the distance of the anchors
};

/// A kind of joint, made of parts.
struct JointKindEntry {
  std::string_view name;
  JointKind kind;
  std::vector<JointPart> parts;
  /// What remains free and has a name; with the parts' rows at most JointRows::most.
  std::vector<JointCoordinate> coordinates;
  bool uses_axes = true;  ///< false: the parts only ask for the anchors
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

/// The number of a coordinate by its name; none: coordinates.size().
size_t coordinate_named(JointKind kind, std::string_view name);

}  // namespace tumble
