#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <span>

#include <Eigen/Core>

namespace tumble {

/// The world, a fixed body: no degrees of freedom.
inline constexpr uint32_t no_block = 0xffffffffu;

/// The degrees of freedom of one body (six) or particle (three: no inertia, no rotation), with its
/// present velocity. What moves by itself (kinematic bodies) has no inverse mass and a velocity.
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

/// A row of the Jacobian J of impulses, contact forces and joints: one scalar relative velocity,
/// and the direction in which one scalar impulse acts.
struct Row {
  RowSide a, b;
};

/// Velocity along `direction` of a point of B relative to the same point of A; arms from the
/// centres of mass [m].
Row point_row(uint32_t block_a, const Vec3& arm_a, uint32_t block_b, const Vec3& arm_b,
              const Vec3& direction);

/// J v of the row.
double row_velocity(const Row& row, std::span<const DofBlock> blocks);
/// v += M^-1 J^T impulse.
void apply_row(const Row& row, double impulse, std::span<DofBlock> blocks);

/// The Delassus matrix J M^-1 J^T: symmetric, positive semi-definite.
Eigen::MatrixXd delassus(std::span<const Row> rows, std::span<const DofBlock> blocks);

}  // namespace tumble
