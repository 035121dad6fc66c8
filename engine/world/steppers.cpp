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

std::vector<std::string_view> stepper_names() {
  std::vector<std::string_view> names;
  for (const StepperEntry& entry : all_steppers()) names.push_back(entry.name);
  return names;
}

}  // namespace tumble
