#pragma once
#include "engine/math/lcp/problem.hpp"

#include <string_view>

namespace tumble::lcp {

enum class LcpStatus : uint8_t {
  solved,            ///< residual within the tolerance asked for
  infeasible,        ///< proved to have no solution: `ray` is the proof (see ray_residual())
  ray,               ///< ended on the ray given; for matrices that are not semi-definite no proof
  not_semidefinite,  ///< the method needs a positive semi-definite A, and this is none
  singular,          ///< enumeration only: none found, and singular sets left it undecided
  max_iterations,    ///< the limit of pivots or iterations came first; z is the best known
  cycling,           ///< a set of clamped unknowns came back without progress
  numeric,           ///< ended, but the residual of the answer is too large to be believed
};

/// What a solver says about its answer. Residuals are those of validate().
struct LcpReport {
  LcpStatus status = LcpStatus::max_iterations;
  int iterations = 0;          ///< pivots of the pivoting methods, sweeps or steps of the others
  double residual = 0;         ///< greatest violation of any condition [-]
  double complementarity = 0;  ///< greatest product of distance from a bound and |w| [-]
  std::string_view solver;     ///< name of the one that answered, in all_lcp_solvers()

  bool solved() const { return status == LcpStatus::solved; }
};

struct LcpSolution {
  VecX z, w;  ///< w = A z + b
  VecX ray;   ///< with status infeasible or ray, else empty
  LcpReport report;
};

/// What a stage of solve_cones() came to.
struct ConeAttempt {
  std::string_view stage;
  LcpStatus status = LcpStatus::max_iterations;
  int iterations = 0;
  double residual = 0;
  bool sliding = false;  ///< one of those for sliding groups
};

struct LcpOptions {
  double tolerance = 1e-9;  ///< largest residual that counts as solved
  int max_iterations = 0;   ///< 0: the method's own limit
};

}  // namespace tumble::lcp
