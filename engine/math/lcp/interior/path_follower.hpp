#pragma once
#include "engine/math/lcp/system/cone_system.hpp"

namespace tumble::lcp {

/// Follows the central path of a system (smoothed_map.hpp) to its end by Newton's method with a
/// line search, the smoothing falling as fast as that goes well; then semi-smooth Newton for the
/// digits that the end lacks, where its residual is above `polish_above`. `weight` is added to the
/// diagonal of A in linear systems only. The report's solver is cone_interior.
LcpSolution solve_along_path(ConeSystem& system, const LcpOptions& options, double weight,
                             double polish_above);

}  // namespace tumble::lcp
