#pragma once
#include <algorithm>
#include <cstdlib>

namespace tumble::test {

/// Whether the environment variable TUMBLE_TEST_SCALE is set: 1 for the full tests, a fiftieth
/// where the gate runs tests under sanitizers. Without it tests run the counts of the gate.
inline bool scale_is_set() {
  return std::getenv("TUMBLE_TEST_SCALE") != nullptr;
}

/// TUMBLE_TEST_SCALE, or 1 without it.
inline double scale() {
  const char* text = std::getenv("TUMBLE_TEST_SCALE");
  const double value = text ? std::atof(text) : 1.0;
  return value > 0 ? value : 1.0;
}

/// `count` random cases, scaled, but at least `least`.
inline int scaled_count(int count, int least = 1) {
  return std::max(least, int(double(count) * scale()));
}

}  // namespace tumble::test
