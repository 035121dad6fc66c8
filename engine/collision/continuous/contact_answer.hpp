#pragma once
#include "engine/collision/continuous/moving_distance.hpp"
#include "engine/collision/continuous/probe.hpp"
#include "engine/collision/time_of_contact.hpp"

#include <array>

namespace tumble {

/// Apart until t, nearest there as given.
void set_nearest(TimeOfContact& answer, const Nearest& now, double t);

/// What is nearest when the contact is at t, and one look ahead, to where a head-on contact would
/// overlap. The status is left alone.
void set_contact(TimeOfContact& answer, MovingDistance& pair, const Nearest& now, double t,
                 double t1, double tolerance, ContactTimeTrace* trace = nullptr);

/// What an onlooker gets of a query at t, the contact being known to lie in `bracket` if anywhere.
ContactTimeProbe probe_of(const Nearest& now, double t, const std::array<double, 2>& bracket,
                          double speed);

/// The answer for the same shapes in the other order.
TimeOfContact exchanged(TimeOfContact answer);

/// Nothing touches before t.
inline TimeOfContact separated_until(double t) {
  TimeOfContact r;
  r.time = r.low = r.high = t;
  return r;
}

}  // namespace tumble
