#pragma once
#include "engine/math/lcp/report.hpp"

#include <array>

namespace tumble::lcp {

/// The convex set of the values of one unknown, or of the three of a group, that are compatible
/// with w: one factor of the set of all solutions with that w.
struct SolutionCell {
  enum Kind : uint8_t {
    interval,  ///< one unknown in [lower, upper]
    origin,    ///< all 0
    ray,       ///< (a, t) = a (1, tie), a >= 0
    disc,      ///< |t| <= slope a
    square,    ///< |t_k| <= slope a, or t_k = a tie_k where tied
  } kind = interval;
  int size = 1;
  std::array<int, 3> unknown{};  ///< the axial one first
  double lower = 0, upper = 0, slope = 0;
  std::array<double, 2> tie{};
  std::array<bool, 2> tied{};

  using Point = std::array<double, 3>;
  using Matrix = std::array<Point, 3>;
  /// The nearest point of the set, and an element of the generalised Jacobian of that projection
  /// (symmetric).
  Point project(const Point& x, Matrix& jacobian) const;
};

/// The sets for w, whose entries below `still` (in units in which A_ii is 1) count as 0.
std::vector<SolutionCell> solution_cells(const LcpProblem& problem, const VecX& z, const VecX& w,
                                         double still);

}  // namespace tumble::lcp
