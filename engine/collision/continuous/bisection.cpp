#include "engine/collision/continuous/bisection.hpp"

#include "engine/collision/continuous/contact_answer.hpp"
#include "engine/collision/continuous/mesh_advancement.hpp"
#include "engine/collision/continuous/mesh_distance.hpp"
#include "engine/collision/continuous/vertex_core.hpp"
#include "engine/core/stop.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr int most_queries = 1024;

struct Moment {
  double t = 0;
  Nearest near;
};

class Bisection {
 public:
  Bisection(MovingDistance& distance, double t0, double t1, double tolerance,
            ContactTimeTrace* trace)
      : distance_(distance), t1_(t1), tolerance_(tolerance), trace_(trace) {
    apart_.t = t0;
    apart_ = moment(t0);
  }

  TimeOfContact run() {
    if (near_enough()) return finish(TimeOfContactStatus::initially_overlapping);
    if (safe_until() >= t1_) return separated();
    later_.push_back(moment(t1_));
    while (answer_.iterations < most_queries && !stop_requested()) {
      while (!later_.empty() && free_until(later_.back())) {
        move_to(later_.back());
        later_.pop_back();
        if (near_enough()) return finish(TimeOfContactStatus::contact);
      }
      if (later_.empty() || safe_until() >= t1_) return separated();
      if (!divide()) break;
      if (near_enough()) return finish(TimeOfContactStatus::contact);
    }
    set_nearest(answer_, apart_.near, apart_.t);
    answer_.high = later_.empty() ? t1_ : later_.front().t;
    answer_.status = TimeOfContactStatus::max_iterations;
    return answer_;
  }

 private:
  enum class Division { newton, middle, safe_step };

  Moment moment(double t) {
    ++answer_.iterations;
    const double span = std::max(t1_ - t, t - apart_.t);
    const Moment m{t, distance_.at(t, distance_.fastest() * span + 2 * tolerance_)};
    if (trace_) {
      const double high = later_.empty() ? t1_ : later_.front().t;
      const double speed = distance_.approach(m.near.normal);
      trace_->push_back(probe_of(m.near, t, {apart_.t, high}, speed));
    }
    return m;
  }
  bool near_enough() const { return apart_.near.distance <= tolerance_; }
  void move_to(const Moment& m) {
    apart_ = m;
    next_ = Division::newton;
  }
  /// Time until which the two are proven apart, by half the tolerance.
  double safe_until() const {
    const double speed = distance_.approach(apart_.near.normal);
    if (!(speed > 0)) return t1_;
    return apart_.t + (apart_.near.distance - 0.5 * tolerance_) / speed;
  }
  bool free_until(const Moment& m) const {
    const double least = 0.25 * tolerance_;
    if (!(m.near.distance > least)) return false;
    const double closes = distance_.approach(apart_.near.normal);
    const double opens = distance_.approach(-m.near.normal);
    if (!(closes > 0) || !(opens > 0)) return true;
    return (apart_.near.distance - least) / closes + (m.near.distance - least) / opens >=
           m.t - apart_.t;
  }
  /// Time at which the nearest points would meet.
  double newton_time() const {
    const double closing = distance_.closing(apart_.near, apart_.t);
    if (!(closing > 0)) return t1_;
    return apart_.t + (apart_.near.distance - 0.5 * tolerance_) / closing;
  }
  /// Measures at one more time before the next known one. False if there is no such time in double
  /// precision.
  bool divide() {
    const double end = later_.back().t, safe = safe_until();
    const double half = apart_.t + 0.5 * (end - apart_.t);
    if (next_ == Division::newton) {
      next_ = Division::middle;
      const double t = newton_time();
      if (t > safe && t < end) return add(t);
    }
    if (next_ == Division::middle) {
      next_ = Division::safe_step;
      if (half > safe && half < end) return add(half);
    }
    next_ = Division::newton;
    if (!(safe > apart_.t && safe < end)) return false;
    move_to(moment(safe));
    return true;
  }
  /// A contact ends the search: later times do not matter.
  bool add(double t) {
    const Moment m = moment(t);
    if (m.near.distance <= tolerance_) later_.clear();
    later_.push_back(m);
    return true;
  }
  TimeOfContact separated() {
    set_nearest(answer_, apart_.near, apart_.t);
    answer_.status = TimeOfContactStatus::separated;
    answer_.time = answer_.low = answer_.high = t1_;
    return answer_;
  }
  TimeOfContact finish(TimeOfContactStatus status) {
    answer_.status = status;
    set_contact(answer_, distance_, apart_.near, apart_.t, t1_, tolerance_, trace_);
    return answer_;
  }

  MovingDistance& distance_;
  double t1_, tolerance_;
  ContactTimeTrace* trace_;
  Moment apart_;               ///< nothing touches up to here
  std::vector<Moment> later_;  ///< the nearest in time last
  Division next_ = Division::newton;
  TimeOfContact answer_;
};

}  // namespace

TimeOfContact bisect(MovingDistance& distance, double t0, double t1, double tolerance,
                     ContactTimeTrace* trace) {
  return Bisection(distance, t0, t1, tolerance, trace).run();
}

TimeOfContact find_by_bisection(const MovingPair& p) {
  const double t0 = p.t0(), t1 = p.t1();
  if (p.half_space()) {
    if (p.b.convex()) {
      HalfSpaceDistance distance(p.motion_a, p.core_b());
      return bisect(distance, t0, t1, p.tolerance);
    }
    const VertexCore vertices(*p.surface_b().mesh);
    HalfSpaceDistance distance(p.motion_a,
                               {vertices, p.motion_b, p.lever_b(), p.b.bounding_radius()});
    return bisect(distance, t0, t1, p.tolerance);
  }
  if (p.both_convex()) {
    ConvexDistance distance(p.core_a(), p.core_b(), p.tolerance);
    return bisect(distance, t0, t1, p.tolerance);
  }
  const std::unique_ptr<MovingDistance> distance = mesh_distance(p);
  TimeOfContact found = bisect(*distance, t0, t1, p.tolerance);
  if (found.status != TimeOfContactStatus::initially_overlapping) return found;
  found = find_by_advancement(p);
  found.method = "conservative_advancement";
  return found;
}

}  // namespace tumble
