#pragma once
#include "engine/math/lcp/report.hpp"

#include <string_view>
#include <vector>

namespace tumble::lcp {

/// A solver and what it can do. Each refuses what it cannot with an Error.
struct LcpSolverEntry {
  std::string_view name;
  bool unsymmetric;  ///< A need not be symmetric
  bool undecided;    ///< groups of mode undecided
  bool sliding;      ///< groups of mode sliding
  bool proves;       ///< for semi-definite A without groups: solves, or proves infeasible
  Result<LcpSolution> (*solve)(const LcpProblem&, const LcpOptions&);
};

/// "dantzig", "baraff", "lemke", "pgs", "cone_newton", "cone_interior", "enumeration" (the
/// reference, for 12 unknowns).
const std::vector<LcpSolverEntry>& all_lcp_solvers();

}  // namespace tumble::lcp
