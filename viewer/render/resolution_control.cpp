#include "viewer/render/resolution_control.hpp"

#include <algorithm>
#include <array>

namespace tumble {
namespace {

/// Each has about 0.7 times the pixels of the one before; below the last, edges are seen as stairs.
constexpr std::array<float, 5> steps = {1, 0.84f, 0.71f, 0.59f, 0.5f};

constexpr double slow = 1.0 / 30;  ///< longer is no longer seen as motion [s]
constexpr int patience = 6;        ///< slow pictures in a row until there are fewer pixels
/// Quick pictures in a row until more pixels are tried; each trial that was soon given up doubles
/// it, so that pictures do not pulse.
constexpr int first_wait = 30, longest_wait = 960;
constexpr int soon = 60;  ///< [pictures]

double pixels_of(int step) {
  return double(steps[size_t(step)]) * double(steps[size_t(step)]);
}

}  // namespace

float ResolutionControl::resolution() const {
  return steps[size_t(step_)];
}

/// By as many steps as it takes if all of the time goes with the pixels.
void ResolutionControl::lower() {
  wait_ = since_raise_ < soon ? std::min(2 * wait_, longest_wait) : first_wait;
  const double now = pixels_of(step_);
  do ++step_;
  while (step_ + 1 < int(steps.size()) && least_slow_ * pixels_of(step_) > slow * now);
  slow_ = quick_ = 0;
}

void ResolutionControl::see(double seconds) {
  since_raise_ = std::min(since_raise_ + 1, soon);
  const bool is_slow = seconds > slow;
  least_slow_ = is_slow && slow_ > 0 ? std::min(least_slow_, seconds) : seconds;
  slow_ = is_slow ? slow_ + 1 : 0;
  if (slow_ >= patience && step_ + 1 < int(steps.size())) return lower();
  if (is_slow || step_ == 0) {
    quick_ = 0;
    return;
  }
  const double with_more = seconds * pixels_of(step_ - 1) / pixels_of(step_);
  quick_ = with_more < 0.9 * slow ? quick_ + 1 : 0;
  if (quick_ < wait_) return;
  --step_;
  slow_ = quick_ = since_raise_ = 0;
}

}  // namespace tumble
