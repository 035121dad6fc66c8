#include "engine/dynamics/rows/rows.hpp"

namespace tumble {
namespace {

void apply_side(const RowSide& s, double impulse, std::span<DofBlock> blocks) {
  if (s.block == no_block) return;
  DofBlock& block = blocks[s.block];
  block.v += impulse * block.inverse_mass * s.linear;
  block.omega += impulse * (block.inverse_inertia * s.angular);
}

}  // namespace

Row point_row(uint32_t block_a, const Vec3& arm_a, uint32_t block_b, const Vec3& arm_b,
              const Vec3& direction) {
  Row out;
  put_point_row(block_a, arm_a, block_b, arm_b, direction, out);
  return out;
}

void apply_row(const Row& row, double impulse, std::span<DofBlock> blocks) {
  apply_side(row.a, impulse, blocks);
  apply_side(row.b, impulse, blocks);
}

}  // namespace tumble
