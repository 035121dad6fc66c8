#include "engine/dynamics/joints/joint_kinds.hpp"

namespace tumble {

const std::vector<JointKindEntry>& all_joint_kinds() {
  static const std::vector<JointKindEntry> kinds = {
      {"spherical", JointKind::spherical, {anchors_together}, false, "ball in a socket"},
      {"universal",
       JointKind::universal,
       {anchors_together, axes_perpendicular},
       true,
       "cardan joint: two axes that cross at right angles"},
      {"revolute", JointKind::revolute, {anchors_together, axes_aligned}, true, "hinge"},
      {"cylindrical",
       JointKind::cylindrical,
       {anchor_on_line, axes_aligned},
       true,
       "sleeve on a round rod"},
      {"prismatic", JointKind::prismatic, {anchor_on_line, no_rotation}, true, "slider in a rail"},
      {"rigid", JointKind::rigid, {anchors_together, no_rotation}, true, "welded together"},
      {"distance", JointKind::distance, {anchors_apart}, true, "rod without mass"},
      {"planar", JointKind::planar, {anchor_in_plane, axes_aligned}, true, "puck on a table"},
  };
  return kinds;
}

}  // namespace tumble
