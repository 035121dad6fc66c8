#pragma once
#include "engine/math/lcp/system/cone_system.hpp"

namespace tumble::lcp {

/// Follows the central path of a system (smoothed_map.hpp) to its end by Newton's method with a
/// line search, decreasing the smoothing as fast as that converges; then, if the residual is above
/// `polish_above`, applies semi-smooth Newton for the remaining accuracy. `weight` is added to the
/// diagonal of A in linear systems only. The report names cone_interior as the solver.
LcpSolution solve_along_path(ConeSystem& system, const LcpOptions& options, double weight,
                             double polish_above);

}  // namespace tumble::lcp
