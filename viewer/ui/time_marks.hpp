#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A moment that a person wants to come back to.
struct Bookmark {
  uint64_t tick = 0;
  std::string name;
  bool operator==(const Bookmark&) const = default;
};

/// From one tick to a later one.
struct TickSpan {
  uint64_t from = 0, to = 0;
  bool operator==(const TickSpan&) const = default;
};

/// What a person has marked on the line of time: bookmarks, by tick and one a tick, and the span
/// that is played over and over.
struct TimeMarks {
  std::vector<Bookmark> bookmarks;
  std::optional<TickSpan> span;  ///< none: nothing could be looped
  bool looping = false;

  /// A bookmark there, or the one that is there no more. An empty name: "mark N".
  void toggle(uint64_t tick, std::string name = {});
  void remove(size_t index);
  /// The nearest bookmark after a tick, or before it; null: none.
  const Bookmark* next(uint64_t tick) const;
  const Bookmark* previous(uint64_t tick) const;
  /// Between the bookmarks about a tick, or the ends of what is known where there are none; none
  /// where that has no length.
  std::optional<TickSpan> span_about(uint64_t tick, uint64_t first, uint64_t last) const;
  /// Marks one end of the span. The other one gives way where it would come to lie on the wrong
  /// side.
  void begin_span(uint64_t tick, uint64_t last);
  void end_span(uint64_t tick, uint64_t first);
  bool operator==(const TimeMarks&) const = default;
};
inline const TimeMarks no_time_marks;

/// Which tick is at what time, in a run whose ticks may become shorter or longer on the way. Knows
/// what it has seen; ticks that are yet to come are as long as the last one.
class TickClock {
 public:
  explicit TickClock(double tick_seconds) : parts_{{0, 0, tick_seconds}} {}

  /// The moment that is shown now; what was known of later ones is another course of history.
  void see(uint64_t tick, double time, double tick_seconds);
  double time_of(uint64_t tick) const;  ///< [s]
  /// The tick nearest to a time [s].
  uint64_t tick_at(double time) const;

 private:
  /// From a tick on, until the next one.
  struct Part {
    uint64_t tick = 0;
    double time = 0, tick_seconds = 0;
  };
  std::vector<Part> parts_;  ///< ascending; never empty
};
inline const TickClock usual_tick_clock{1.0 / 60};

}  // namespace tumble
