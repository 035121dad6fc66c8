#include "engine/world/step_event.hpp"
#include "engine/world/step_realtime.hpp"

namespace tumble {

const std::vector<StepperEntry>& all_steppers() {
  static const std::vector<StepperEntry> list = {
      {"event", step_event},
      {"realtime", step_realtime},
  };
  return list;
}

}  // namespace tumble
