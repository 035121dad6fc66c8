#pragma once
// Cases under the event stepper, as tests run them.
#include "tests/support/accuracy/tumble_case.hpp"
#include "tests/support/scale.hpp"

#include <algorithm>
#include <cstdlib>
#include <functional>

#include <doctest/doctest.h>

namespace tumble::test {

/// `full` seconds when TUMBLE_TEST_SCALE is 1 (the full tests) in an optimised build; a part of
/// them, `gate`, in the gate; less with smaller scales and in the slow builds of the full tests.
inline double case_seconds(double full, double gate) {
  if (!test::scale_is_set()) return gate;
#ifndef NDEBUG
  full = std::min(full, 0.1 * gate);
#endif
  return std::max(0.05, full * std::min(1.0, test::scale()));
}

inline WorldSettings event_settings() {
  WorldSettings s;
  s.stepper = "event";
  s.event.budget = 1000000;  // what is claimed of events is not left to time-stepping
  return s;
}

/// Any complaint of the engine fails the test, and so does a contact that is deeper than 1e-5 m at
/// the end of a step; none of the cases begins with an overlap.
inline CaseMaker event_maker(const WorldSettings& settings = event_settings(),
                             std::function<void(const World&)> after_step = {}) {
  const auto watch = [after_step](const World& w) {
    CHECK(w.frame()->stats.max_penetration < 1e-5);
    if (after_step) after_step(w);
  };
  return tumble_maker(settings, {[](const std::string& m) { FAIL("the engine: ", m); }, watch});
}

}  // namespace tumble::test
