#include "engine/world/step_realtime.hpp"

namespace tumble {

const std::vector<StepperEntry>& all_steppers() {
  static const std::vector<StepperEntry> list = {
      {"realtime", step_realtime},
  };
  return list;
}

}  // namespace tumble
