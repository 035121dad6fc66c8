#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace tumble {

/// Indices of a brick, or of a node, along x, y, z.
using GridIndex = std::array<int32_t, 3>;

/// A scalar function on the nodes of a cubic grid, stored in bricks of 8 x 8 x 8 nodes where it is
/// known; everywhere else it is `outside`. Negative is inside.
struct SparseField {
  static constexpr int edge = 8;  ///< nodes along a brick
  struct Brick {
    GridIndex at{};                                ///< its first node is edge * at
    std::array<double, edge * edge * edge> value;  ///< x runs fastest
  };

  double spacing = 1;         ///< of the nodes [m]; node (i, j, k) is at spacing * (i, j, k)
  double outside = 1;         ///< greater than 0
  std::vector<Brick> bricks;  ///< sorted by `at`, none twice

  /// Where a node is [m].
  Vec3 position(const GridIndex& node) const {
    return spacing * Vec3(double(node[0]), double(node[1]), double(node[2]));
  }
  /// The brick at a place; null where there is none.
  const Brick* find(const GridIndex& at) const;
};

/// Bricks that a field may have: 4 KiB each.
inline constexpr size_t most_bricks = size_t{1} << 18;

/// Ok when the spacing is finite and greater than 0 and the box is neither so far away nor so large
/// that its nodes cannot be counted. Errors say which spacing would do.
Status check_spacing(double spacing, const Aabb& box);

/// The function f(position) [m -> any unit] sampled in the bricks that a box touches. The surface
/// f = 0 ends where they end.
Result<SparseField> sample_field(const std::function<double(const Vec3&)>& f, const Aabb& box,
                                 double spacing);

}  // namespace tumble
