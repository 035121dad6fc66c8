#pragma once
#include "engine/geometry/continuous_tests/moving.hpp"

#include <cmath>

namespace tumble {

/// Magnitudes at which the predicates of `triangle_pairs.hpp` are exact.
template <size_t n>
bool within_exact_range(const std::array<const MovingPoint*, n>& points) {
  const auto fits = [](double x) {
    return x == 0 || (std::fabs(x) > 1e-70 && std::fabs(x) < 1e70);
  };
  for (const MovingPoint* p : points) {
    for (int k = 0; k < 3; ++k) {
      if (!fits(p->start[k]) || !fits(p->end[k])) return false;
    }
  }
  return true;
}

/// Whether they meet at t = 0, exactly. False also where predicates would not be exact.
template <size_t n, class Meet>
bool meets_at_start(const std::array<const MovingPoint*, n>& points, const Meet& meet) {
  return within_exact_range(points) && meet(&MovingPoint::start);
}

/// At t = 0 and t = 1 positions are doubles, so that exact predicates decide what the march left in
/// doubt there: `meet(&MovingPoint::start)`, `meet(&MovingPoint::end)`.
template <size_t n, class Meet>
void decide_at_ends(MovingContact& contact, const std::array<const MovingPoint*, n>& points,
                    const Meet& meet) {
  const bool at_start = contact.t_lo == 0, at_end = contact.t_hi == 1;
  if (!(at_start || at_end) || !within_exact_range(points)) return;
  if (at_start && meet(&MovingPoint::start)) {
    contact.t_hi = 0;
    contact.certain = true;
  } else if (at_end && meet(&MovingPoint::end)) {
    contact.certain = true;
  }
}

}  // namespace tumble
