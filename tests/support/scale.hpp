#pragma once
#include <algorithm>
#include <cstdlib>

namespace tumble::test {

/// Whether the environment variable TUMBLE_TEST_SCALE is set: 1 for the full tests, a fiftieth
/// where the gate runs tests under sanitizers. Without it tests run the counts of the gate.
inline bool scale_is_set() {
  return std::getenv("TUMBLE_TEST_SCALE") != nullptr;
}

/// Of random cases the gate draws this share, so that it ends within half an hour.
constexpr double gate_scale = 0.4;

/// TUMBLE_TEST_SCALE, or the gate's share without it.
inline double scale() {
  const char* text = std::getenv("TUMBLE_TEST_SCALE");
  const double value = text ? std::atof(text) : gate_scale;
  return value > 0 ? value : gate_scale;
}

/// Whether everything is asked for, as by `./dev test --full`.
inline bool all_counts() {
  return scale_is_set() && scale() >= 1;
}

/// Whether code is only to be seen running, as under sanitizers: what takes long goes on for some
/// steps, and figures that it would reach later are not looked at.
inline bool only_to_run() {
  return scale() < gate_scale;
}

/// `count` random cases, scaled, but at least `least`.
inline int scaled_count(int count, int least = 1) {
  return std::max(least, int(double(count) * scale()));
}

/// `full` cases when all are asked for, a part of them, `gate`, where nothing is asked, fewer under
/// sanitizers; at least `least`.
inline int graded_count(int full, int gate, int least = 1) {
  return scale_is_set() ? scaled_count(full, least) : gate;
}

}  // namespace tumble::test
