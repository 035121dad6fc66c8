#pragma once
#include "engine/math/lcp/system/cone_system.hpp"

namespace tumble::lcp {

/// Smooth approximation of the conditions of a unit: F(z, w) whose zeros with w = A z + b converge
/// to the solutions as the smoothing t goes to 0. For t > 0 they form the central path:
/// complementary quantities have the product t^2, and both are inside their cones.
///
/// Unknowns with bounds and the axial ones of sliding groups use the Chen-Harker-Kanzow-Smale
/// function, g(v) = (v + sqrt(v^2 + 4 t^2)) / 2. A circular group is, by De Saxcé's change of
/// variable (De Saxcé & Feng 1998), x = (slope z_a, z_t) and y = (w_a / slope + |w_t|, w_t) in the
/// same self-dual cone with x y = 0, and g is applied to the spectral values of x - y (Fukushima,
/// Luo & Tseng, "Smoothing functions for second-order-cone complementarity problems", SIAM J.
/// Optim. 12, 2001). |w_t| is smoothed at 0 by t^2, in units of `scale`, the greatest |b|, which is
/// the size of w_t on the path of a group at rest: with larger values the path might not reach t =
/// 0.
UnitValue smoothed_value(const ConeUnit& unit, const Triple& z, const Triple& w, double smoothing,
                         double scale);

}  // namespace tumble::lcp
