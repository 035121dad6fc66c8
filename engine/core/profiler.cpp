#include "engine/core/profiler.hpp"

#include <algorithm>

namespace tumble {

void StageTimes::add(std::string_view name, double seconds) {
  StageTime* const end = times_.data() + size_;
  StageTime* at =
      std::find_if(times_.data(), end, [&](const StageTime& s) { return s.name == name; });
  if (at == end && size_ == most) --at;
  if (at == end) {
    *at = {name, 0};
    ++size_;
  }
  at->seconds += seconds;
}

double Profiler::total() const {
  double sum = 0;
  for (const StageTime& s : stages_) sum += s.seconds;
  return sum;
}

}  // namespace tumble
