#include "engine/collision/continuous/advancement.hpp"

#include "engine/collision/continuous/contact_answer.hpp"
#include "engine/core/stop.hpp"

namespace tumble {
namespace {

constexpr int max_steps = 1024;

}  // namespace

TimeOfContact advance(MovingDistance& pair, double t0, double t1, double tolerance,
                      ContactTimeTrace* trace) {
  TimeOfContact r;
  r.low = r.time = t0;
  r.high = t1;
  double t = t0;
  for (r.iterations = 1; r.iterations <= max_steps && !stop_requested(); ++r.iterations) {
    const Nearest now = pair.at(t, pair.fastest() * (t1 - t) + 2 * tolerance);
    if (now.distance <= tolerance) {
      r.status = t > t0 ? TimeOfContactStatus::contact : TimeOfContactStatus::initially_overlapping;
      set_contact(r, pair, now, t, t1, tolerance, trace);
      return r;
    }
    set_nearest(r, now, t);
    if (trace) trace->push_back(probe_of(now, t, {t, r.high}, pair.approach(now.normal)));
    // aim for half the tolerance, so that rounding never carries the step past the contact
    const double step = pair.open_for(now.normal, t, now.distance - 0.5 * tolerance);
    if (!(t + step < t1)) {
      r.status = TimeOfContactStatus::separated;
      r.time = r.low = t1;
      return r;
    }
    if (!(t + step > t)) break;  // the tolerance is below what time resolves
    t += step;
    r.time = r.low = t;
  }
  r.status = TimeOfContactStatus::max_iterations;
  return r;
}

TimeOfContact advance(const MovingCore& a, const MovingCore& b, double t0, double t1,
                      double tolerance, ContactTimeTrace* trace) {
  ConvexDistance distance(a, b, tolerance);
  return advance(distance, t0, t1, tolerance, trace);
}

TimeOfContact advance_half_space(const Motion& plane, const MovingCore& b, double t0, double t1,
                                 double tolerance, ContactTimeTrace* trace) {
  HalfSpaceDistance distance(plane, b);
  return advance(distance, t0, t1, tolerance, trace);
}

}  // namespace tumble
