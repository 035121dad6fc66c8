#pragma once
#include "engine/collision/continuous/contact_answer.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

/// Combines the results for pairs of triangles over parts of the interval: the earliest contact,
/// and the pairs that were within the tolerance from the start.
class EarliestContact {
 public:
  explicit EarliestContact(double t1) : t1_(t1), best_(separated_until(t1)) {}

  /// Time up to which a further pair need be examined: that of the earliest contact so far.
  double time() const { return best_.time; }
  bool found() const { return best_.status != TimeOfContactStatus::separated; }

  /// Adds the result of one pair of triangles for a part of the interval. Returns true if the two
  /// were within the tolerance already at the start of the whole interval; such a pair is to be
  /// left out from then on.
  bool offer(const TimeOfContact& answer, uint32_t ta, uint32_t tb, bool first_part) {
    const int iterations = best_.iterations + answer.iterations;
    const bool initial = answer.status == TimeOfContactStatus::initially_overlapping;
    if (initial && first_part) note(answer, ta, tb);
    // Within the tolerance at the start of a later part: that is the time of contact.
    const bool hit = answer.hit() || (initial && !first_part);
    const bool unknown = answer.status == TimeOfContactStatus::max_iterations;
    if ((hit || unknown) && answer.time < best_.time) {
      best_ = answer;
      if (hit) best_.status = TimeOfContactStatus::contact;
      best_.triangle_a = ta, best_.triangle_b = tb;
    }
    best_.iterations = iterations;
    return initial && first_part;
  }
  void add_iterations(int n) { best_.iterations += n; }

  /// The earliest contact; if there is none, the nearest pair that was within the tolerance from
  /// the start; else separated.
  TimeOfContact answer() const {
    if (best_.time < t1_ || best_.hit() || !any_initial_) return best_;
    TimeOfContact r = initial_;
    r.iterations = best_.iterations;
    return r;
  }

 private:
  void note(const TimeOfContact& found, uint32_t ta, uint32_t tb) {
    if (any_initial_ && initial_.distance_low <= found.distance_low) return;
    initial_ = found, any_initial_ = true;
    initial_.triangle_a = ta, initial_.triangle_b = tb;
  }

  double t1_;
  TimeOfContact best_, initial_;
  bool any_initial_ = false;
};

/// Divides an interval, in which a pair moves by `way`, into equal parts in each of which it moves
/// by about `size` [m].
struct IntervalParts {
  double t0, t1;
  int count;

  IntervalParts(double from, double to, double way, double size, double most) : t0(from), t1(to) {
    count = size > 0 ? int(std::clamp(std::ceil(way / size), 1.0, most)) : int(most);
  }
  double from(int k) const { return t0 + (t1 - t0) * k / count; }
  double to(int k) const { return k + 1 == count ? t1 : t0 + (t1 - t0) * (k + 1) / count; }
};

}  // namespace tumble
