#pragma once
#include "engine/math/lcp/problem.hpp"

#include <string_view>

namespace tumble::lcp {

enum class LcpStatus : uint8_t {
  solved,      ///< the residual is within the given tolerance
  infeasible,  ///< proved to have no solution: `ray` is the proof (see ray_residual())
  /// Ended on the ray in `ray`; no proof for matrices that are not semi-definite.
  ray,
  not_semidefinite,  ///< the method needs a positive semi-definite A, and this one is not
  singular,          ///< enumeration only: none found, and singular sets left it undecided
  max_iterations,    ///< the limit of pivots or iterations was reached; z is the best found
  cycling,           ///< a set of clamped unknowns came back without progress
  numeric,           ///< ended, but the residual is too large
};

/// Report of a solver on its result. Residuals are those of validate().
struct LcpReport {
  LcpStatus status = LcpStatus::max_iterations;
  int iterations = 0;          ///< pivots of the pivoting methods, sweeps or steps of the others
  double residual = 0;         ///< greatest violation of any condition [-]
  double complementarity = 0;  ///< greatest product of distance from a bound and |w| [-]
  std::string_view solver;     ///< name of the solver that gave the result, in all_lcp_solvers()

  bool solved() const { return status == LcpStatus::solved; }
};

struct LcpSolution {
  VecX z, w;  ///< w = A z + b
  VecX ray;   ///< with status infeasible or ray, else empty
  LcpReport report;
};

/// Result of a stage of solve_cones().
struct ConeAttempt {
  std::string_view stage;
  LcpStatus status = LcpStatus::max_iterations;
  int iterations = 0;
  double residual = 0;
  bool sliding = false;  ///< one of those for sliding groups
};

struct LcpOptions {
  double tolerance = 1e-9;  ///< largest residual of a solved problem
  int max_iterations = 0;   ///< 0: the method's own limit
};

}  // namespace tumble::lcp
