#include "engine/dynamics/joints/joint_kinds.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr bool angle = true, turns = true;

}  // namespace

const std::vector<JointKindEntry>& all_joint_kinds() {
  static const std::vector<JointKindEntry> kinds = {
      {"spherical",
       JointKind::spherical,
       {anchors_together},
       {{"swing", swing_angle, angle}, {"twist", twist_angle, angle, turns}},
       false,
       "ball in a socket"},
      {"universal",
       JointKind::universal,
       {anchors_together, axes_perpendicular},
       {{"angle", first_angle, angle, turns}, {"angle_2", second_angle, angle, turns}},
       true,
       "cardan joint: two axes that cross at right angles"},
      {"revolute",
       JointKind::revolute,
       {anchors_together, axes_aligned},
       {{"angle", twist_angle, angle, turns}},
       true,
       "hinge"},
      {"cylindrical",
       JointKind::cylindrical,
       {anchor_on_line, axes_aligned},
       {{"position", offset_z}, {"angle", twist_angle, angle, turns}},
       true,
       "sleeve on a round rod"},
      {"prismatic",
       JointKind::prismatic,
       {anchor_on_line, no_rotation},
       {{"position", offset_z}},
       true,
       "slider in a rail"},
      {"rigid", JointKind::rigid, {anchors_together, no_rotation}, {}, true, "welded together"},
      {"distance", JointKind::distance, {anchors_apart}, {}, true, "rod without mass"},
      {"planar",
       JointKind::planar,
       {anchor_in_plane, axes_aligned},
       {{"x", offset_x}, {"y", offset_y}, {"angle", twist_angle, angle, turns}},
       true,
       "puck on a table"},
      {"free",
       JointKind::free,
       {},
       {{"length", anchor_distance}},
       true,
       "rope, strut or piston between two points, as limits, springs and motors make it"},
  };
  return kinds;
}

size_t coordinate_named(JointKind kind, std::string_view name) {
  const std::vector<JointCoordinate>& all = entry_of(kind).coordinates;
  return size_t(std::ranges::find(all, name, &JointCoordinate::name) - all.begin());
}

}  // namespace tumble
