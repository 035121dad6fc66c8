#pragma once
#include "engine/geometry/distance_field/field_layout.hpp"
#include "engine/geometry/distance_field/tile_kernels.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <span>
#include <vector>

namespace tumble {

class Crew;

/// The triangles near each tile of nodes (tile_kernels.hpp). Tiles have the places of blocks.
struct NearTriangles {
  /// Tiles with triangles (FieldLayout::block_index), ascending.
  std::vector<size_t> tiles;
  std::vector<size_t> first;        ///< start in `triangles` by tile, and the end
  std::vector<uint32_t> triangles;  ///< ascending for each tile
  /// By triangle of the mesh: so narrow that its normal has lost digits.
  std::vector<uint8_t> narrow;

  std::span<const uint32_t> of(size_t n) const {
    return {triangles.data() + first[n], first[n + 1] - first[n]};
  }
};

/// All tiles with a node that may be within `range` [m] of a triangle, each with the triangles that
/// may be within it of any of its nodes.
NearTriangles triangles_near_tiles(const TriangleMesh& mesh, const FieldLayout& layout,
                                   double range, Crew* crew);

/// Measures tiles one after the other, keeping its memory.
class TileMeasure {
 public:
  /// Squared distances of the nodes of the n-th tile with triangles from the nearest one, no more
  /// than the square of the range [m^2]; until the next call.
  const TileDistances& squares(const TriangleMesh& mesh, const FieldLayout& layout, double range,
                               const NearTriangles& near, size_t n);

 private:
  void measure_narrow(const TriangleMesh& mesh, const Vec3& first, double cell);

  TileTriangles triangles_;
  std::vector<uint32_t> narrow_;
  TileDistances best_;
};

}  // namespace tumble
