#include "engine/world/step_event.hpp"
#include "engine/world/step_realtime.hpp"

namespace tumble {

const std::vector<StepperEntry>& all_steppers() {
  static const std::vector<StepperEntry> list = {
      {"event", step_event, false},
      {"realtime", step_realtime, true},
  };
  return list;
}

}  // namespace tumble
