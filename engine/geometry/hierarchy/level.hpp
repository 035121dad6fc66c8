#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// The volumes of the nodes `level` levels below the root and of the leaves above that level, first
/// child first: together they hold the whole mesh, each triangle in one. A level below the deepest
/// gives the leaves, one above the root the root. Empty without nodes. Valid as long as the
/// hierarchy.
std::vector<NodeBound> level_bounds(const Hierarchy& hierarchy, int level);

/// Draws them, each in the colour of the triangles that it holds.
void draw_level(const Hierarchy& hierarchy, int level, const Pose& pose, DebugDraw& out);

/// The colour of a volume: once around the hues in the order in which the tree holds the triangles
/// of the mesh, so that a node has a mean hue of its children. Linear, opaque.
Vec4f node_colour(const Hierarchy& hierarchy, const NodeBound& bound);

/// How much room the volumes take; less is better.
struct HierarchyRoom {
  size_t nodes = 0, leaves = 0;
  double root_volume = 0;   ///< of the root's volume [m^3]
  double root_surface = 0;  ///< [m^2]
  double leaf_volume = 0;   ///< sum over the leaves [m^3]
  double leaf_surface = 0;  ///< [m^2]
  /// Sum of all surfaces over the root's: how many volumes random lines meet for each that meets
  /// the root's (Cauchy and Crofton), which the surface-area heuristic makes small.
  double nodes_per_line = 0;
};
HierarchyRoom measure_room(const Hierarchy& hierarchy);

}  // namespace tumble
