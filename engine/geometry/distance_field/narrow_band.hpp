#pragma once
#include "engine/geometry/distance_field/field_layout.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

class Crew;

/// The triangles near each block.
struct BlockTriangles {
  /// Block indices (FieldLayout::block_index) with triangles, ascending.
  std::vector<size_t> blocks;
  std::vector<size_t> first;        ///< start in `triangles` by block, and the end
  std::vector<uint32_t> triangles;  ///< ascending for each block

  std::span<const uint32_t> of(size_t n) const {
    return {triangles.data() + first[n], first[n + 1] - first[n]};
  }
};

/// All blocks with a node that may be within `range` [m] of a triangle, each with the triangles
/// that may be within it of any of its nodes.
BlockTriangles triangles_near_blocks(const TriangleMesh& mesh, const FieldLayout& layout,
                                     double range, Crew* crew);

/// Unsigned distances of the nodes of a block [m].
using BlockDistances = std::array<double, FieldLayout::nodes_of_block>;

/// Distance of each node from the nearest of some triangles, or infinity if it exceeds `range`.
void measure_block(const TriangleMesh& mesh, const FieldLayout& layout, size_t block,
                   std::span<const uint32_t> triangles, double range, BlockDistances& out);

}  // namespace tumble
