#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <span>

namespace tumble {

/// Stands for the world, or another immovable body without degrees of freedom.
inline constexpr uint32_t no_block = 0xffffffffu;

/// The degrees of freedom of one body (six) or particle (three: no rotation, zero inverse inertia),
/// with its present velocity. Kinematic bodies have a velocity and zero inverse mass.
struct DofBlock {
  double inverse_mass = 0;              ///< [1/kg]
  Mat3 inverse_inertia = Mat3::Zero();  ///< about the centre of mass, world axes [1/(kg m2)]
  Vec3 v = Vec3::Zero();                ///< of the centre of mass [m/s]
  Vec3 omega = Vec3::Zero();            ///< world axes [rad/s]
};

/// One side of a row: its share of the row's velocity is linear.v + angular.omega of the block.
struct RowSide {
  uint32_t block = no_block;
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

/// A row of a Jacobian J, shared by impulses, contact forces and joints: one scalar relative
/// velocity, and the direction along which one scalar impulse acts.
struct Row {
  RowSide a, b;
};

/// The row for the velocity along `direction` of a point of B relative to the coinciding point of
/// A; arms are from the centres of mass to the point [m].
inline void put_point_row(uint32_t block_a, const Vec3& arm_a, uint32_t block_b, const Vec3& arm_b,
                          const Vec3& direction, Row& out) {
  out.a.block = block_a;
  out.a.linear = -direction;
  out.a.angular = -arm_a.cross(direction);
  out.b.block = block_b;
  out.b.linear = direction;
  out.b.angular = arm_b.cross(direction);
}
Row point_row(uint32_t block_a, const Vec3& arm_a, uint32_t block_b, const Vec3& arm_b,
              const Vec3& direction);

/// The contribution of a side to J v.
inline double side_velocity(const RowSide& s, std::span<const DofBlock> blocks) {
  if (s.block == no_block) return 0;
  const DofBlock& block = blocks[s.block];
  return s.linear.dot(block.v) + s.angular.dot(block.omega);
}
/// J v of the row.
inline double row_velocity(const Row& row, std::span<const DofBlock> blocks) {
  return side_velocity(row.a, blocks) + side_velocity(row.b, blocks);
}
/// v += M^-1 J^T impulse.
void apply_row(const Row& row, double impulse, std::span<DofBlock> blocks);

}  // namespace tumble
