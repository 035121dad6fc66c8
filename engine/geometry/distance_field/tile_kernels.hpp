#pragma once
#include "engine/geometry/distance_field/field_layout.hpp"

#include <array>
#include <vector>

namespace tumble {

/// A tile has the nodes of a block without the last along each axis, which are in the blocks after
/// it: so every node is measured once, in rows as long as a logical vector.
inline constexpr int tile_nodes = FieldLayout::cells_along;
inline constexpr size_t nodes_of_tile = size_t{tile_nodes} * tile_nodes * tile_nodes;

inline constexpr size_t node_in_tile(int x, int y, int z) {
  return size_t((z * tile_nodes + y) * tile_nodes + x);
}

/// Squared distances of a tile's nodes [m^2], by node_in_tile().
using TileDistances = std::array<double, nodes_of_tile>;

/// The triangles near a tile as columns of numbers, one for each quantity, by coordinates relative
/// to the tile's first node. Corners are given, prepare_triangles() computes the others. Triangles
/// so narrow that their normals have lost digits must not be among them.
class TileTriangles {
 public:
  /// The columns; those of several numbers are that many columns.
  enum Column : size_t {
    corner = 0,                   ///< coordinates of the three corners [m]
    normal = corner + 9,          ///< unit, along the plane's
    inward = normal + 3,          ///< within the plane, from each side to the inside [m]
    inverse_square = inward + 9,  ///< of the length of each side [1/m^2]
    middle = inverse_square + 3,  ///< centroid [m]
    radius = middle + 3,          ///< of a ball about it [m]
    columns = radius + 1
  };
  /// Columns are filled up to a multiple of this, so that vectors may read past the last triangle.
  static constexpr size_t batch = 8;

  void resize(size_t count) {
    count_ = count;
    stride_ = (count + batch - 1) / batch * batch;
    values_.resize(stride_ * columns);
  }
  /// Forgets all but the first `count`, which may be fewer than there was room for.
  void keep(size_t count) { count_ = count; }
  size_t size() const { return count_; }
  double* column(size_t n) { return values_.data() + n * stride_; }
  const double* column(size_t n) const { return values_.data() + n * stride_; }

 private:
  size_t count_ = 0, stride_ = 0;
  std::vector<double> values_;
};

void prepare_triangles(TileTriangles& triangles);

/// Lowers the squared distances of a tile's nodes, which are `cell` apart, to those of the nearest
/// of the triangles. `within` [m^2] is the largest of them before.
void measure_tile(const TileTriangles& triangles, double cell, double within, TileDistances& best);

}  // namespace tumble
