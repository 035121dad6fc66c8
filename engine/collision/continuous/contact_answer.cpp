#include "engine/collision/continuous/contact_answer.hpp"

#include <algorithm>
#include <utility>

namespace tumble {

void set_nearest(TimeOfContact& answer, const Nearest& now, double t) {
  answer.time = answer.low = t;
  answer.distance_low = now.distance;
  answer.on_a = now.on_a, answer.on_b = now.on_b, answer.normal = now.normal;
  answer.triangle_a = now.triangle_a, answer.triangle_b = now.triangle_b;
}

void set_contact(TimeOfContact& answer, MovingDistance& pair, const Nearest& now, double t,
                 double t1, double tolerance, ContactTimeTrace* trace) {
  set_nearest(answer, now, t);
  const double speed = std::max(pair.approach(now.normal), 1e-3 * pair.fastest());
  if (trace) trace->push_back(probe_of(now, t, {t, t1}, speed));
  answer.high = speed > 0 ? std::min(t1, t + 2 * now.distance / speed) : t1;
  const Nearest ahead = pair.at(answer.high, 4 * tolerance);
  if (trace) trace->push_back(probe_of(ahead, answer.high, {t, answer.high}, 0));
  answer.distance_high = ahead.distance;
}

ContactTimeProbe probe_of(const Nearest& now, double t, const std::array<double, 2>& bracket,
                          double speed) {
  return {t, bracket[0], bracket[1], now.distance, now.on_a, now.on_b, now.normal, speed};
}

TimeOfContact exchanged(TimeOfContact answer) {
  std::swap(answer.on_a, answer.on_b);
  std::swap(answer.triangle_a, answer.triangle_b);
  std::swap(answer.features[0], answer.features[1]);
  answer.normal = -answer.normal;
  return answer;
}

}  // namespace tumble
