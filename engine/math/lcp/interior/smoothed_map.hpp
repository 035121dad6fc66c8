#pragma once
#include "engine/math/lcp/system/cone_system.hpp"

namespace tumble::lcp {

/// Smooth stand-ins for the conditions of a unit: F(z, w) whose zeros at w = A z + b are, as the
/// smoothing t goes to 0, the solutions. For t > 0 they are the central path: what is complementary
/// has the product t^2, both factors inside their cones.
///
/// Unknowns with bounds and the axial ones of sliding groups use the function of Chen, Harker,
/// Kanzow and Smale, g(v) = (v + sqrt(v^2 + 4 t^2)) / 2. A circular group is, by the change of
/// variable of De Saxcé (De Saxcé & Feng 1998), x = (slope z_a, z_t) and y = (w_a / slope + |w_t|,
/// w_t) in the same self-dual cone with x y = 0, and g is applied to the spectral values of x - y
/// (Fukushima, Luo & Tseng, "Smoothing functions for second-order-cone complementarity problems",
/// SIAM J. Optim. 12, 2001). |w_t| is rounded off by t^2, in units of `scale`, the greatest |b|,
/// which is what w_t is on the path where the group rests: with more the path need not go on to
/// t = 0.
UnitValue smoothed_value(const ConeUnit& unit, const Triple& z, const Triple& w, double smoothing,
                         double scale);

}  // namespace tumble::lcp
