#include "viewer/render/resolution_control.hpp"

#include <algorithm>
#include <array>

namespace tumble {
namespace {

/// Each has about 0.7 times the pixels of the one before; below the last, edges look like stairs.
constexpr std::array<float, 5> scales = {1, 0.84f, 0.71f, 0.59f, 0.5f};

/// Pictures that take longer are not perceived as fluent motion [s]. This is a ninth above the
/// period of a display of 30 Hz, so that waiting for such a display, with its jitter, does not
/// count as slow.
constexpr double slow = 1.0 / 27;
constexpr int patience = 6;  ///< slow pictures in a row until the resolution is lowered
/// Quick pictures in a row until a higher resolution is tried; each trial that was soon given up
/// doubles the number, so that the resolution does not oscillate.
constexpr int first_wait = 30, longest_wait = 960;
constexpr int soon = 60;  ///< a trial that ends within this many pictures was given up soon
/// If fewer pixels leave more than this share of the time, lowering was in vain: most of the time
/// is spent on something else, such as the simulation or the display.
constexpr double in_vain = 0.9;
/// A picture that took up to this many periods of the display was in time, given jitter.
constexpr double on_time = 1.1;
constexpr double worse = 1.25;  ///< lowering is tried again when pictures take this many times
                                ///< longer than when it was in vain

double pixels_of(int step) {
  return double(scales[size_t(step)]) * double(scales[size_t(step)]);
}

}  // namespace

float ResolutionControl::resolution() const {
  return scales[size_t(step_)];
}

/// Lowers by as many steps as are needed if the time is proportional to the pixels.
void ResolutionControl::lower() {
  wait_ = since_raise_ < soon ? std::min(2 * wait_, longest_wait) : first_wait;
  const double now = pixels_of(step_);
  from_ = step_;
  do ++step_;
  while (step_ + 1 < int(scales.size()) && least_slow_ * pixels_of(step_) > slow * now);
  before_ = least_slow_;
  trial_ = patience;
  slow_ = quick_ = 0;
}

/// Whether it has now turned out that the last lowering was in vain.
bool ResolutionControl::lowered_in_vain(double seconds) {
  if (trial_ == 0) return false;
  least_trial_ = trial_ == patience ? seconds : std::min(least_trial_, seconds);
  return --trial_ == 0 && least_trial_ > in_vain * before_;
}

void ResolutionControl::go_back() {
  step_ = from_;
  vain_ = before_;
  slow_ = quick_ = 0;
}

void ResolutionControl::see(double seconds, double period) {
  since_raise_ = std::min(since_raise_ + 1, soon);
  const bool is_slow = seconds > slow;
  least_slow_ = is_slow && slow_ > 0 ? std::min(least_slow_, seconds) : seconds;
  slow_ = is_slow ? slow_ + 1 : 0;
  fluent_ = is_slow ? 0 : std::min(fluent_ + 1, longest_wait);
  if (fluent_ == longest_wait) vain_ = 0;
  if (lowered_in_vain(seconds)) return go_back();
  if (slow_ >= patience) {
    if (step_ + 1 < int(scales.size()) && least_slow_ > worse * vain_) return lower();
    slow_ = 0;  // the pictures after the change are judged anew
  }
  if (is_slow || step_ == 0) {
    quick_ = 0;
    return;
  }
  // For a picture that was in time for the display, it is unknown how much earlier it could have
  // been ready; so a higher resolution is tried.
  const bool in_time = seconds < on_time * period;
  const double with_more = seconds * pixels_of(step_ - 1) / pixels_of(step_);
  quick_ = in_time || with_more < 0.9 * slow ? quick_ + 1 : 0;
  if (quick_ < wait_) return;
  --step_;
  slow_ = quick_ = since_raise_ = 0;
}

}  // namespace tumble
