#include "viewer/ui/history.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr double smoothing = 0.08;

}  // namespace

void History::add(const Frame& frame) {
  while (!samples_.empty() && samples_.back().tick >= frame.tick) {
    if (samples_.back().tick == frame.tick) return;
    samples_.pop_back();
  }
  Sample sample{frame.tick, frame.time, frame.stats.energies, {}, 0};
  if (frame.ledger) {
    for (size_t i = 0; i < ledger_lines; ++i)
      sample.ledger[i] = float(frame.ledger->line(LedgerLine(i)).total().balance);
    double forces = 0;
    for (const ForceAccount& f : frame.ledger->forces()) forces += f.account.total().balance;
    sample.ledger.back() = float(forces);
  }
  for (const StageTime& stage : frame.stats.stages) {
    sample.step_seconds += stage.seconds;
    const auto it = std::find_if(stages_.begin(), stages_.end(),
                                 [&](const Stage& s) { return s.name == stage.name; });
    if (it == stages_.end())
      stages_.push_back({std::string(stage.name), stage.seconds});
    else
      it->smoothed += smoothing * (stage.seconds - it->smoothed);
  }
  if (samples_.size() >= capacity) samples_.erase(samples_.begin());
  samples_.push_back(sample);
}

void History::clear() {
  samples_.clear();
  stages_.clear();
}

double History::smoothed_step() const {
  double sum = 0;
  for (const Stage& stage : stages_) sum += stage.smoothed;
  return sum;
}

}  // namespace tumble
