#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/joints/joint_push.hpp"
#include "engine/dynamics/realtime/joint_pass.hpp"

#include <array>
#include <cstdint>

namespace tumble {

/// One joint of an island as the inner loops see it. All its rows are solved at once: the kept rows
/// (constraints of its parts), followed by one row for each coordinate along which something acts.
/// Impulses are those of one sub-step.
struct JointBlock {
  static constexpr size_t most = JointRows::most;
  /// A row. The linear parts for A and B are opposite for all kinds of joints.
  struct Line {
    Vec3 linear;  ///< on B; the negative on A
    Vec3 angular_a, angular_b;
    double error = 0;  ///< JointRow::error
    double bias = 0;   ///< JointRow::bias
  };
  using Values = std::array<double, most>;

  uint32_t a = 0, b = 0;     ///< solver bodies
  uint32_t source = 0;       ///< index into the joints
  uint32_t kept = 0;         ///< number of rows of the parts
  uint32_t count = 0;        ///< number of all rows
  uint32_t first_drive = 0;  ///< index of the DriveRow of its first coordinate row
  bool coupled = false;      ///< solved together with others: see CoupledJoints
  std::array<Line, most> lines;
  Vec3 arm_b = Vec3::Zero();  ///< from B's centre of mass to its anchor, where `lines` are [m]
  /// K = J M^-1 J^T as L D L^T: L below the diagonal, 1/D on it (0 for linearly dependent rows).
  /// Only the kept rows are eliminated; the block of the coordinates is what remains of K, their
  /// compliance.
  std::array<Values, most> factor;
  // Impulses of the passes. In ordinary islands those of the correcting pass are discarded after
  // each sub-step.
  Values moving{};
  Values correcting{};  ///< of kept rows; those of coordinates are in `moving`
  Values relaxing{};
  struct {
    Values moving{}, relaxing{};
  } before_blow;            ///< see remember_impulses
  Values speeds{};          ///< of rows before a pass, in ticks in which something bounces
  Values before_bounces{};  ///< `relaxing` before contacts bounced
  JointPush sum;            ///< over the sub-steps so far

  /// The impulse of a row that a pass changes.
  double& impulse(uint32_t row, JointPass pass) {
    if (pass == JointPass::relaxing) return relaxing[row];
    return pass == JointPass::correcting && row < kept ? correcting[row] : moving[row];
  }
  /// Adds what its rows or couplings do in a pass to the sum.
  void add(JointPush push) {
    push.twist = push.moment_b - arm_b.cross(push.impulse);
    sum.add(push);
  }
  /// The whole impulse of a row before the bodies move (`moving`, `correcting`), or after it
  /// (`relaxing`).
  double total(uint32_t row, JointPass pass) const {
    return pass == JointPass::relaxing ? relaxing[row] : moving[row] + correcting[row];
  }
};

}  // namespace tumble
