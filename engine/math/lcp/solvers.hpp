#pragma once
#include "engine/math/lcp/report.hpp"

#include <string_view>
#include <vector>

namespace tumble::lcp {

/// A solver and its capabilities. It returns an Error for problems that it cannot handle.
struct LcpSolverEntry {
  std::string_view name;
  bool unsymmetric;  ///< accepts an unsymmetric A
  bool undecided;    ///< accepts groups of mode undecided
  bool sliding;      ///< accepts groups of mode sliding
  bool proves;       ///< for semi-definite A without groups: solves, or proves infeasible
  Result<LcpSolution> (*solve)(const LcpProblem&, const LcpOptions&);
};

/// "dantzig", "baraff", "lemke", "pgs", "cone_newton", "cone_interior", "enumeration" (the
/// reference, for 12 unknowns).
const std::vector<LcpSolverEntry>& all_lcp_solvers();

}  // namespace tumble::lcp
