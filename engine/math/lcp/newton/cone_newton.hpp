#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Semi-smooth Newton on the function of Alart & Curnier (Comput. Methods Appl. Mech. Eng. 92,
/// 1991) with a line search; for bounds and cones of all kinds. Proximal steps about the last point
/// make the linear systems regular where rows are redundant, and vanish as they converge, so that
/// nothing is regularised in the answer; the first is taken about 0, which keeps redundant unknowns
/// small and symmetric. Where Newton stalls it starts again from ever more sweeps of projected
/// Gauss-Seidel. `iterations` counts linear systems. Errors: those of check().
Result<LcpSolution> cone_newton(const LcpProblem& problem, const LcpOptions& options = {});

/// The same from a given z, in the problem's units.
Result<LcpSolution> cone_newton_from(const LcpProblem& problem, const LcpOptions& options,
                                     const VecX& z);

/// Takes z of a solution nearer to where all conditions hold, by the same steps from there and no
/// other start; leaves it where none is nearer.
void polish(const LcpProblem& problem, const LcpOptions& options, LcpSolution& solution);

}  // namespace tumble::lcp
