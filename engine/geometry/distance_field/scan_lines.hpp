#pragma once
#include "engine/geometry/distance_field/field_layout.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>
#include <vector>

namespace tumble {

class Crew;

/// A crossing of the surface with a row of nodes along x: it is ahead of the nodes before `node`.
struct RowCrossing {
  uint32_t row;
  int32_t node;
  int32_t turns;  ///< contribution to the winding number of those nodes: 1 or -1
};

/// The crossings of all rows of a grid with a closed mesh, exactly as ray_crossing() decides them.
class ScanLines {
 public:
  ScanLines(const TriangleMesh& mesh, const FieldLayout& layout, Crew* crew);

  /// Crossings of a row, in the order of their nodes.
  std::span<const RowCrossing> row(int y, int z) const;
  /// Winding numbers of `count` nodes of a row, `step` apart.
  void winding(int y, int z, int first, int count, int step, int* out) const;
  /// Whether the number of crossings ahead of each of these nodes is odd.
  void parity(int y, int z, int first, int count, int step, bool* out) const;

 private:
  size_t rows_along_y_;
  std::vector<size_t> first_;  ///< of each row, and the end
  std::vector<RowCrossing> crossings_;
};

}  // namespace tumble
