#pragma once
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
};

/// A kind of joint, made of parts.
struct JointKindEntry {
  std::string_view name;
  JointKind kind;
  std::vector<JointPart> parts;
  bool uses_axes = true;  ///< false: only the anchors matter
  std::string_view doc;   ///< for lists of choices
};

/// "spherical", "universal", ... in the order of JointKind.
const std::vector<JointKindEntry>& all_joint_kinds();
inline const JointKindEntry& entry_of(JointKind kind) {
  return all_joint_kinds()[size_t(kind)];
}

}  // namespace tumble
