#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <array>
#include <cstddef>

namespace tumble {

constexpr size_t block_triangles = 128;

/// Sums over a block of triangles about an origin: the ten of MomentSums (6 volume; 24 moment x, y,
/// z; 120 second moment xx, yy, zz, xy, yz, zx) and its two sizes.
constexpr size_t moment_sum_count = 12;
using BlockSums = std::array<double, moment_sum_count>;

/// Sums over block_triangles triangles, by four lanes in the order of the triangles.
using AddBlock = void (*)(const Vec3* vertices, const Triangle* triangles, const Vec3& origin,
                          BlockSums& out);

/// With the instructions that every machine has, two triangles at a time.
void add_block_baseline(const Vec3* vertices, const Triangle* triangles, const Vec3& origin,
                        BlockSums& out);

/// The fastest that this machine has: all give the same bits.
AddBlock fastest_add_block();

}  // namespace tumble
