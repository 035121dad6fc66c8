#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace tumble {

/// Positions of the nodes, cells and blocks of a distance field. Nodes are `cell` apart; a block is
/// 8 x 8 x 8 cells and stores its 9 x 9 x 9 nodes, duplicating those on faces shared with
/// neighbours, so that a query reads one block.
struct FieldLayout {
  static constexpr int cells_along = 8, nodes_along = cells_along + 1;
  static constexpr size_t nodes_of_block = size_t{nodes_along} * nodes_along * nodes_along;

  Vec3 origin = Vec3::Zero();  ///< node (0, 0, 0) [m]
  double cell = 1;             ///< [m]
  std::array<int, 3> blocks{0, 0, 0};

  double block_size() const { return cell * cells_along; }
  size_t block_count() const { return size_t(blocks[0]) * size_t(blocks[1]) * size_t(blocks[2]); }
  size_t block_index(int x, int y, int z) const {
    return (size_t(z) * size_t(blocks[1]) + size_t(y)) * size_t(blocks[0]) + size_t(x);
  }
  std::array<int, 3> block_place(size_t index) const {
    const auto x = size_t(blocks[0]), y = size_t(blocks[1]);
    return {int(index % x), int(index / x % y), int(index / (x * y))};
  }
  /// Corners of blocks: one more than blocks along each axis.
  size_t corner_count() const {
    return size_t(blocks[0] + 1) * size_t(blocks[1] + 1) * size_t(blocks[2] + 1);
  }
  size_t corner_index(int x, int y, int z) const {
    return (size_t(z) * size_t(blocks[1] + 1) + size_t(y)) * size_t(blocks[0] + 1) + size_t(x);
  }
  static size_t node_in_block(int x, int y, int z) {
    return size_t((z * nodes_along + y) * nodes_along + x);
  }
  /// Coordinate of a node along one axis [m].
  double at(int axis, int node) const { return origin[axis] + cell * node; }
  Vec3 node(int x, int y, int z) const { return {at(0, x), at(1, y), at(2, z)}; }
  Aabb box() const {
    return {origin,
            node(cells_along * blocks[0], cells_along * blocks[1], cells_along * blocks[2])};
  }
};

}  // namespace tumble
