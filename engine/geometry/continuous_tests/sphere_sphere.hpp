#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/continuous_tests/moving.hpp"

#include <optional>

namespace tumble {

/// A ball whose centre moves linearly.
struct MovingSphere {
  MovingPoint centre;
  double radius = 0;  ///< [m], >= 0
};

/// When two moving balls first touch (Coutinho 2013 §2.5.16): the smaller root of the quadratic
/// |x(t)|^2 = r^2. Whether and between which doubles is decided by exact signs; contacts are always
/// certain and [t_lo, t_hi] is a few units of rounding wide, save where the balls graze: there it
/// is what the signs of doubles can tell, up to 1e-7. `parameters` stay zero.
///
/// Exact when coordinates and radii are zero or within 1e50 of the largest. Refuses non-finite
/// input and negative radii.
Result<std::optional<MovingContact>> moving_spheres_contact(const MovingSphere& a,
                                                            const MovingSphere& b);

}  // namespace tumble
