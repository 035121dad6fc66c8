#pragma once
#include "engine/geometry/hierarchy/hierarchy.hpp"

namespace tumble {

/// The volumes of the nodes `level` levels below the root and of the leaves above that level, in
/// depth-first order: together they contain the whole mesh, each triangle once. A level below the
/// deepest gives the leaves, a negative one the root. Empty without nodes. Valid during the life of
/// the hierarchy.
std::vector<NodeBound> level_bounds(const Hierarchy& hierarchy, int level);

/// Draws these volumes, each in the colour of its triangles.
void draw_level(const Hierarchy& hierarchy, int level, const Pose& pose, DebugDraw& out);

/// The colour of a volume: the hue follows the order of the triangles in the tree, once around the
/// colour circle, so that a node has the mean hue of its children. Linear, opaque.
Vec4f node_colour(const Hierarchy& hierarchy, const NodeBound& bound);

/// Sizes of the volumes; smaller is better.
struct HierarchyRoom {
  size_t nodes = 0, leaves = 0;
  double root_volume = 0;   ///< of the root's volume [m^3]
  double root_surface = 0;  ///< [m^2]
  double leaf_volume = 0;   ///< sum over the leaves [m^3]
  double leaf_surface = 0;  ///< [m^2]
  /// Sum of all surfaces divided by the root's: the expected number of volumes met by a random line
  /// that meets the root's (Cauchy and Crofton), which the surface-area heuristic minimises.
  double nodes_per_line = 0;
};
HierarchyRoom measure_room(const Hierarchy& hierarchy);

}  // namespace tumble
