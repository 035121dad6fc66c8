#pragma once
#include "engine/geometry/hierarchy/level.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// What `tumble mesh` reports about one kind of bounding hierarchy of a mesh.
struct HierarchyFacts {
  std::string kind;
  size_t nodes = 0, leaves = 0;
  int depth = 0;
  size_t bytes = 0;
  double bytes_per_triangle = 0;
  double build_ms = 0;  ///< wall time in this run, not a property of the mesh
  /// Volume of the root over that of the mesh's hull, at least 1 [-]; empty for a flat mesh.
  std::optional<double> root_over_hull;
  /// Total surface of the leaves' volumes over that of the mesh [-]; empty for a mesh without area.
  std::optional<double> leaves_over_mesh;
  double nodes_per_line = 0;  ///< HierarchyRoom::nodes_per_line
};

/// Builds every kind of hierarchy that has volumes and measures it. `hull_volume` 0: flat. Tells
/// its progress, from the share `done_before` to 1.
std::vector<HierarchyFacts> hierarchy_facts(const std::shared_ptr<const TriangleMesh>& mesh,
                                            double hull_volume, double area, double done_before);

}  // namespace tumble
