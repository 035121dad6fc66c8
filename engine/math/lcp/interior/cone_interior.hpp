#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Follows the central path (smoothed_map.hpp) to its end by Newton's method with a line search,
/// decreasing the smoothing as fast as that converges, and polishes by cone_newton: a non-interior
/// path-following method (Hayashi, Yamashita & Fukushima, "A combined smoothing and regularization
/// method for monotone second-order cone complementarity problems", SIAM J. Optim. 15, 2005),
/// applied to friction in the form of Acary, Cadoux, Lemaréchal & Malick ("A formulation of the
/// linear discrete Coulomb friction problem via convex optimization", ZAMM 91, 2011). Groups at the
/// edge between two states, at which cone_newton stalls, do not affect it, but it cannot use a
/// start. If there is no solution the path has no end; if there are several it may turn back before
/// its end. `iterations` counts linear systems. Errors: those of check().
Result<LcpSolution> cone_interior(const LcpProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
