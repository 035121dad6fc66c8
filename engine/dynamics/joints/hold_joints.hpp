#pragma once
#include "engine/dynamics/joints/joint.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Joints as equations for exact steppers: of accelerations, velocities and positions. All changes
/// are the least ones in the metric of mass, so that redundant joints are allowed.

/// The rows of all joints, in order, at the bodies' present poses and velocities. Their blocks are
/// block_of[slot] (no_block for what cannot be moved).
void joint_equations(std::span<const Joint> joints, std::span<const RigidBody> bodies,
                     std::span<const uint32_t> block_of, std::vector<JointRow>& rows);

/// Changes accelerations, which the blocks hold in v and omega, so that J a + bias = 0 (Coutinho
/// 2013 §5.6.2 for joints alone).
void hold_accelerations(std::span<const JointRow> rows, std::span<DofBlock> accelerations);

/// Changes velocities so that J v = 0.
void hold_velocities(std::span<const JointRow> rows, std::span<DofBlock> velocities);

/// Moves bodies so that C = 0 to about `tolerance`: Newton steps, at most eight. `slots` are the
/// bodies of the blocks. Gives what error is left [m, rad].
double hold_positions(std::span<const Joint> joints, std::span<RigidBody> bodies,
                      std::span<const uint32_t> slots, std::span<const uint32_t> block_of,
                      double tolerance = 1e-14);

}  // namespace tumble
