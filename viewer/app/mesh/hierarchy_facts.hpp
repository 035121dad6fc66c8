#pragma once
#include "engine/geometry/hierarchy/level.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// What `tumble mesh` says of one kind of tree over a mesh.
struct HierarchyFacts {
  std::string kind;
  size_t nodes = 0, leaves = 0;
  int depth = 0;
  size_t bytes = 0;
  double bytes_per_triangle = 0;
  double build_ms = 0;  ///< wall time of this run: no fact of the mesh
  /// Volume of the root over that of the mesh's hull, at least 1; nothing for a flat mesh.
  std::optional<double> root_over_hull;
  /// Surface of all leaves' volumes over that of the mesh; nothing for a mesh without area.
  std::optional<double> leaves_over_mesh;
  double nodes_per_line = 0;  ///< HierarchyRoom::nodes_per_line
};

/// Builds every kind that has volumes and measures them. `hull_volume` 0: flat.
std::vector<HierarchyFacts> hierarchy_facts(const std::shared_ptr<const TriangleMesh>& mesh,
                                            double hull_volume, double area);

}  // namespace tumble
