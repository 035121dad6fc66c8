#pragma once
#include "engine/math/lcp/report.hpp"

namespace tumble::lcp {

/// Follows the central path (smoothed_map.hpp) to its end by Newton's method with a line search,
/// the smoothing falling as fast as that goes well, and polishes by cone_newton: a non-interior
/// path-following method (Hayashi, Yamashita & Fukushima, "A combined smoothing and regularization
/// method for monotone second-order cone complementarity problems", SIAM J. Optim. 15, 2005), on
/// friction as Acary, Cadoux, Lemaréchal & Malick write it ("A formulation of the linear discrete
/// Coulomb friction problem via convex optimization", ZAMM 91, 2011). Indifferent to what makes
/// cone_newton stall, groups at the edge between two states; without its use of a start. Where
/// there is no solution the path has no end; where there are several it may turn back before.
/// `iterations` counts linear systems. Errors: those of check().
Result<LcpSolution> cone_interior(const LcpProblem& problem, const LcpOptions& options = {});

}  // namespace tumble::lcp
