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
  uint32_t source = 0;                    ///< index into the couplings
  std::array<uint32_t, 4> body{};         ///< solver bodies: A and B of x's joint, then of y's
  std::array<uint32_t, 2> block{};        ///< of x's and of y's joint; none where nothing moves it
  std::array<JointBlock::Line, 2> lines;  ///< the halves of its row: see CouplingRow
  double error = 0, bias = 0;
  FollowedCoordinate x, y;
  double moving = 0, correcting = 0, relaxing = 0;  ///< as of JointBlock
  struct {
    double moving = 0, relaxing = 0;
  } before_blow;
  double before_bounces = 0;
};

/// Joints of an island that couplings tie together, directly or over each other, and these
/// couplings. The rows of all of them are solved at once, as those of one joint are: a gear train
/// is as stiff as a hinge, whatever its ratios, and a motor in it feels what it drives.
struct CoupledJoints {
  std::vector<uint32_t> joints;  ///< blocks of the island, ascending
  std::vector<CouplingBlock> couplings;
  double now = 0;  ///< since the tick, or its part, began [s]

  /// A row of any of them.
  struct Line {
    uint32_t ends = 0;
    std::array<uint32_t, 4> body{};
    std::array<Vec3, 4> linear, angular;
  };
  uint32_t kept = 0, count = 0;  ///< rows of parts, then couplings; with those of coordinates
  std::vector<Line> lines;       ///< by row
  std::vector<double> factor;    ///< as JointBlock::factor, row after row
  // Scratch, by row.
  std::vector<double> change, scaled, laws;
  std::vector<double*> impulses;
  std::vector<DriveRow*> drives;
};

/// Groups the joints of an island that couplings tie; `couplings` come with source, body and block
/// set. Their blocks are marked as coupled.
std::vector<CoupledJoints> couple_joints(std::span<JointBlock> joints,
                                         std::span<const CouplingBlock> couplings);

/// These do for coupled joints what the functions of solve_joints.hpp do for others, and for
/// couplings what these do for joints: they are called from there.
void prepare_couplings(const SolverContext& context, const SolverIsland& island, double hs);
/// After the joints' own lines.
void refresh_couplings(const SolverContext& context, const SolverIsland& island, double hs);
/// Once a refresh, before the bodies move: see soften_kept.
void soften_couplings(const SolverIsland& island, double give);
void warm_start_couplings(const SolverIsland& island, double hs, JointPass pass);
void solve_coupled(const SolverIsland& island, double hs, JointPass pass, CoupledJoints& coupled);
/// Adds the pushes to the sums of the joints.
void sum_couplings(const SolverIsland& island, double hs, JointPass pass);
/// Gives the greatest velocity that is left in a row.
double store_couplings(const SolverContext& context, const SolverIsland& island, double hs);

}  // namespace tumble
