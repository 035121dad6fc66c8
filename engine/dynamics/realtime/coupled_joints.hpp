#pragma once
#include "engine/dynamics/joints/joint_coupling.hpp"
#include "engine/dynamics/realtime/drive_row.hpp"
#include "engine/dynamics/realtime/joint_block.hpp"
#include "engine/dynamics/realtime/joint_pass.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

struct SolverContext;
struct SolverIsland;

/// One coupling of an island as the inner loops see it. Impulses are those of one sub-step.
struct CouplingBlock {
  static constexpr uint32_t none = ~uint32_t{0};
  uint32_t source = 0;  ///< index into the couplings
  /// Solver bodies: A and B of the joint of coordinate x, then of y.
  std::array<uint32_t, 4> body{};
  /// Joint blocks of x and of y; none where no body of the joint moves.
  std::array<uint32_t, 2> block{};
  /// The parts of its row from either joint: see CouplingRow.
  std::array<JointBlock::Line, 2> lines;
  double error = 0, bias = 0;
  FollowedCoordinate x, y;
  double moving = 0, correcting = 0, relaxing = 0;  ///< impulses, as in JointBlock
  struct {
    double moving = 0, relaxing = 0;
  } before_blow;
  double speed = 0;  ///< of its row, as JointBlock::speeds
  double before_bounces = 0;

  /// The whole impulse before the bodies move, or after it, as JointBlock::total.
  double total(JointPass pass) const {
    return pass == JointPass::relaxing ? relaxing : moving + correcting;
  }
};

/// Joints of an island that couplings connect, directly or through other joints, and these
/// couplings. All their rows are solved at once, as those of one joint are, so that a gear train is
/// as stiff as a hinge at any ratio, and a motor acts on the inertia of all that it drives.
struct CoupledJoints {
  std::vector<uint32_t> joints;  ///< indices of the island's joint blocks, ascending
  std::vector<CouplingBlock> couplings;
  double now = 0;  ///< time since the tick, or its part, began [s]

  /// A row of any of the joints or couplings.
  struct Line {
    uint32_t ends = 0;
    std::array<uint32_t, 4> body{};
    std::array<Vec3, 4> linear, angular;
  };
  /// `kept`: rows of joint parts, then couplings; `count`: with those of coordinates.
  uint32_t kept = 0, count = 0;
  std::vector<Line> lines;     ///< by row
  std::vector<double> factor;  ///< as JointBlock::factor, `count` entries per row
  // Scratch memory, by row.
  std::vector<double> change, scaled, laws;
  std::vector<double*> impulses;
  std::vector<DriveRow*> drives;
};

/// Groups the joints of an island that couplings connect; `couplings` come with source, body and
/// block set. Marks the blocks of these joints as coupled.
std::vector<CoupledJoints> couple_joints(std::span<JointBlock> joints,
                                         std::span<const CouplingBlock> couplings);

/// These functions do for coupled joints and their couplings what those of solve_joints.hpp do for
/// other joints, and are called from there.
void prepare_couplings(const SolverContext& context, const SolverIsland& island, double hs);
/// To be called after the lines of the joints are refreshed.
void refresh_couplings(const SolverContext& context, const SolverIsland& island, double hs);
/// Once after each refresh before the bodies move: see soften_kept.
void soften_couplings(const SolverIsland& island, double give);
void warm_start_couplings(const SolverIsland& island, double hs, JointPass pass);
void solve_coupled(const SolverIsland& island, double hs, JointPass pass, CoupledJoints& coupled);
/// Adds the impulses of couplings to the sums of the joints.
void sum_couplings(const SolverIsland& island, double hs, JointPass pass);
/// Velocity along the row of one of the couplings.
double speed_along(const SolverIsland& island, const CoupledJoints& all, size_t coupling);
/// Returns the greatest velocity left in a row.
double store_couplings(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
