#pragma once
#include "engine/core/result.hpp"
#include "engine/world/time.hpp"

#include <cstdint>
#include <string_view>

namespace tumble {

/// Greatest numerator and denominator accepted when parsing a fraction.
inline constexpr int64_t greatest_term = 1'000'000'000'000;

/// A positive fraction in lowest terms.
struct Fraction {
  int64_t num = 1;
  int64_t den = 1;
  double value() const { return double(num) / double(den); }
  friend bool operator==(const Fraction&, const Fraction&) = default;
};

/// Parses "30", "2.5" or "30000/1001" exactly; `name` is the option, for the error message. Zero is
/// accepted if `allow_zero`.
Result<Fraction> parse_fraction(std::string_view text, std::string_view name,
                                bool allow_zero = false);

/// Time of a frame relative to the ticks of a world.
struct FrameTime {
  uint64_t tick = 0;     ///< last tick not after the frame
  int64_t rest_num = 0;  ///< the frame is rest_num / rest_den of a tick later
  int64_t rest_den = 1;
  bool exact() const { return rest_num == 0; }
  double s() const { return double(rest_num) / double(rest_den); }
  /// The last tick needed to show the frame.
  uint64_t last_tick() const { return tick + (exact() ? 0 : 1); }
};

/// Frame k shows the state at k / fps; computed in integers, so that it never drifts.
FrameTime frame_time(uint64_t k, Fraction fps, TickRate rate);
/// The number of frames that can be shown once `tick`, at most 2^40, has been simulated; terms of
/// the rates are at most `greatest_term`.
uint64_t frames_until(uint64_t tick, Fraction fps, TickRate rate);
/// Time of frame k, k / fps [s].
double frame_seconds(uint64_t k, Fraction fps);
/// round(seconds * fps), halves upwards.
uint64_t frame_count(Fraction seconds, Fraction fps);
/// round(seconds * tick rate), halves upwards.
uint64_t tick_count(Fraction seconds, TickRate rate);

}  // namespace tumble
