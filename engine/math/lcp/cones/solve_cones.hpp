#pragma once
#include "engine/math/lcp/blocks/block_problem.hpp"
#include "engine/math/lcp/solvers.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

namespace tumble::lcp {

/// A problem with cones, and additional data about it.
struct ConeTask {
  LcpProblem problem;            ///< A may be empty
  std::function<MatX()> matrix;  ///< computes A, when a stage needs it
  /// The same with A = G G^T, if that is faster.
  std::optional<BlockProblem> blocks;
  VecX start;                             ///< initial z, or empty
  bool warm = false;                      ///< the start is the solution of a similar problem
  const LcpSolverEntry* asked = nullptr;  ///< the solver to be tried first, if any
  double tolerance = 1e-9;                ///< largest residual of a solved problem
  double believable = 0;                  ///< residual that is accepted if no stage does better
  bool least = false;                     ///< the solution with this w of least norm (minimum_norm)

  /// The number of unknowns is small enough for dense O(n^3) methods.
  bool few() const { return problem.size() < many_unknowns; }
  static constexpr int many_unknowns = 60;
};

struct ConeAnswer {
  /// Solved, or the residual is acceptable. Otherwise status `infeasible` is a proof, by its ray.
  bool found = false;
  LcpSolution solution;  ///< the best of all attempts
  std::vector<ConeAttempt> attempts;
};

/// A method for such problems.
struct ConeStage {
  std::string_view name;
  bool (*applies)(const ConeTask& task);
  Result<LcpSolution> (*solve)(const ConeTask& task);
  /// Minimal cost in factorisations of a dense symmetric matrix; 0: it does not need the matrix.
  uint64_t factors = 1;
  /// Only for problems with sliding groups: residuals of other stages may be small only because
  /// terms grow without bound.
  bool sliding = false;
};

/// All stages, in the order in which they are tried.
const std::vector<ConeStage>& all_cone_stages();

/// Tries the applicable stages one after the other, until the problem is solved or proved
/// infeasible. Lists every attempt in `attempts`.
ConeAnswer solve_cones(ConeTask& task);

/// The problem without its lateral unknowns, by dantzig(), for a symmetric A. If it is infeasible,
/// so is the problem itself, for any cones: the ray d, 0 in the lateral unknowns, has A d = 0, d >=
/// 0 except in free unknowns, and b d < 0, so that w d = b d < 0 for every z, while w >= 0 in the
/// axial unknowns requires w d >= 0 (ray_residual()). If it has a solution, that solves the problem
/// if no lateral unknown is needed. Cones may make a problem infeasible for other reasons, which
/// this does not detect.
Result<LcpSolution> solve_without_laterals(const LcpProblem& problem);

}  // namespace tumble::lcp
