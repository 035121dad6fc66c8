#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/solvers.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace tumble::lcp {

/// A problem with cones, and what is known of it.
struct ConeTask {
  LcpProblem problem;            ///< A need not be there
  std::function<MatX()> matrix;  ///< A, which is asked for once a stage needs it
  /// The same as A = G G^T, where that is the quicker way.
  std::optional<BlockProblem> blocks;
  VecX start;         ///< a z to begin with, or empty
  bool warm = false;  ///< the start is the answer of a problem that was nearly this one
  const LcpSolverEntry* asked = nullptr;  ///< the solver to be tried first, if any
  double tolerance = 1e-9;                ///< largest residual that counts as solved
  double believable = 0;                  ///< residual that is taken where nothing does better
  bool least = false;                     ///< of all z with this w the least (minimum_norm)

  /// The cube of the number of unknowns is cheap.
  bool few() const { return problem.size() < many_unknowns; }
  static constexpr int many_unknowns = 60;
};

struct ConeAnswer {
  /// Solved, or to be believed. If not, the solution's status `infeasible` is a proof: its ray.
  bool found = false;
  LcpSolution solution;  ///< of all attempts the best
  std::vector<ConeAttempt> attempts;
};

/// A way to solve such problems.
struct ConeStage {
  std::string_view name;
  bool (*applies)(const ConeTask& task);
  Result<LcpSolution> (*solve)(const ConeTask& task);
  /// Factors of the matrix that it takes at least, in those of a symmetric one; 0: it needs none.
  uint64_t factors = 1;
  /// For what slides only: the answers of others may be small beside terms that grow without limit.
  bool sliding = false;
};

/// All of them, in the order in which they are tried.
const std::vector<ConeStage>& all_cone_stages();

/// One stage after the other that applies, until the problem is solved, or proved to have no
/// solution. Every attempt is listed in `attempts`.
ConeAnswer solve_cones(ConeTask& task);

/// The problem without its lateral unknowns, by dantzig(), for a symmetric A. Where it has no
/// solution, none has the problem itself, whatever its cones (status `infeasible`): the ray d, 0 in
/// the lateral unknowns, has A d = 0, d >= 0 but in free unknowns and b d < 0, so that w d = b d <
/// 0 for every z, while w >= 0 in the axial unknowns demands w d >= 0 (ray_residual()). Where it
/// has one, that is an answer if no lateral unknown is needed. Cones may leave no solution for
/// other reasons, which it does not see.
Result<LcpSolution> solve_without_laterals(const LcpProblem& problem);

}  // namespace tumble::lcp
