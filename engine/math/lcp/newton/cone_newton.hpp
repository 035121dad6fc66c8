#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Semi-smooth Newton on the function of Alart & Curnier (Comput. Methods Appl. Mech. Eng. 92,
/// 1991) with a line search; for bounds and cones of all kinds. A weight on the diagonal makes the
/// linear systems regular for redundant rows; the function is without it, so that the result is not
/// regularised (semismooth_newton.hpp). When Newton stalls it restarts after increasing numbers of
/// sweeps of projected Gauss-Seidel. `iterations` counts linear systems. Errors: those of
/// check().
Result<LcpSolution> cone_newton(const LcpProblem& problem, const LcpOptions& options = {});

/// The same from an initial z, in the problem's units.
Result<LcpSolution> cone_newton_from(const LcpProblem& problem, const LcpOptions& options,
                                     const VecX& z);

/// Improves z of a solution by the same steps from there, without other starts; leaves it unchanged
/// if no step does.
void polish(const LcpProblem& problem, const LcpOptions& options, LcpSolution& solution);

}  // namespace tumble::lcp
