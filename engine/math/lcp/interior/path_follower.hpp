#pragma once
#include "engine/math/lcp/system/cone_system.hpp"

#include <functional>

namespace tumble::lcp {

struct PathPlan {
  double weight;        ///< added to the diagonal of A in linear systems only
  double polish_above;  ///< residual at the path's end from where on Newton's method is asked
  std::function<LcpSolution(const VecX& z)> polish;  ///< from a z in the problem's units
};

/// Follows the central path of a system (smoothed_map.hpp) to its end by Newton's method with a
/// line search, the smoothing falling as fast as that goes well; then `polish` for the digits that
/// the end lacks. The report's solver is cone_interior.
LcpSolution solve_along_path(ConeSystem& system, const LcpOptions& options, const PathPlan& plan);

}  // namespace tumble::lcp
