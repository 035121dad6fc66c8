#include "engine/core/profiler.hpp"

namespace tumble {

void Profiler::add(std::string_view name, double seconds) {
  for (StageTime& s : stages_) {
    if (s.name == name) {
      s.seconds += seconds;
      return;
    }
  }
  stages_.push_back({name, seconds});
}

double Profiler::total() const {
  double sum = 0;
  for (const StageTime& s : stages_) sum += s.seconds;
  return sum;
}

}  // namespace tumble
