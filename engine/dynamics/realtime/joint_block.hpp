#pragma once
#include "engine/dynamics/joints/joint.hpp"
#include "engine/dynamics/joints/joint_push.hpp"
#include "engine/dynamics/realtime/joint_pass.hpp"

#include <array>
#include <cstdint>

namespace tumble {

/// One joint of an island as the inner loops see it; all its rows are solved at once, those of
/// coordinates on which something acts behind those that are kept. Impulses are those of one
/// sub-step.
struct JointBlock {
  static constexpr size_t most = JointRows::most;
  /// A row: as all joints push both bodies alike, one linear part serves both.
  struct Line {
    Vec3 linear;  ///< on B; minus it on A
    Vec3 angular_a, angular_b;
    double error = 0;  ///< JointRow::error
    double bias = 0;   ///< JointRow::bias
  };
  using Values = std::array<double, most>;

  uint32_t a = 0, b = 0;     ///< solver bodies
  uint32_t source = 0;       ///< index into the joints
  uint32_t kept = 0;         ///< rows of the parts
  uint32_t count = 0;        ///< all rows
  uint32_t first_drive = 0;  ///< the DriveRow of its first coordinate row
  bool coupled = false;      ///< solved with others: see CoupledJoints
  std::array<Line, most> lines;
  /// K = J M^-1 J^T as L D L^T: below the diagonal L, on it 1/D (0 where rows depend on others).
  /// Only the kept rows are eliminated: the block of the coordinates is what these leave of K, as
  /// compliance.
  std::array<Values, most> factor;
  // Impulses of the passes. In ordinary islands those that work off errors are forgotten with the
  // sub-step.
  Values moving{};
  Values correcting{};  ///< of kept rows; those of coordinates go on with `moving`
  Values relaxing{};
  struct {
    Values moving{}, relaxing{};
  } before_blow;            ///< see remember_impulses
  Values speeds{};          ///< of rows before a pass, of ticks in which something bounces
  Values before_bounces{};  ///< `relaxing` before contacts bounced
  JointPush sum;            ///< of the sub-steps so far

  /// The impulse of a row that a pass changes.
  double& impulse(uint32_t row, JointPass pass) {
    if (pass == JointPass::relaxing) return relaxing[row];
    return pass == JointPass::correcting && row < kept ? correcting[row] : moving[row];
  }
  /// The impulse of a row before the bodies move, or after it.
  double total(uint32_t row, JointPass pass) const {
    return pass == JointPass::relaxing ? relaxing[row] : moving[row] + correcting[row];
  }
};

}  // namespace tumble
