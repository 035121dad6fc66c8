#pragma once
#include "engine/collision/continuous/moving_distance.hpp"
#include "engine/collision/continuous/probe.hpp"
#include "engine/collision/time_of_contact.hpp"

#include <array>

namespace tumble {

/// Sets the result to "apart until t", with the nearest points at that time.
void set_nearest(TimeOfContact& answer, const Nearest& now, double t);

/// Fills in the nearest points at the contact time t, and the evidence at one later time, by which
/// a head-on contact would overlap. The status is not changed.
void set_contact(TimeOfContact& answer, MovingDistance& pair, const Nearest& now, double t,
                 double t1, double tolerance, ContactTimeTrace* trace = nullptr);

/// The record of a distance query at t; the contact, if there is one, is known to lie in `bracket`.
ContactTimeProbe probe_of(const Nearest& now, double t, const std::array<double, 2>& bracket,
                          double speed);

/// The result with the roles of the shapes exchanged.
TimeOfContact exchanged(TimeOfContact answer);

/// The result that nothing touches before t.
inline TimeOfContact separated_until(double t) {
  TimeOfContact r;
  r.time = r.low = r.high = t;
  return r;
}

}  // namespace tumble
