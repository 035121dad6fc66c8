#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A named tick to return to.
struct Bookmark {
  uint64_t tick = 0;
  std::string name;
  bool operator==(const Bookmark&) const = default;
};

/// A span from one tick to a later one.
struct TickSpan {
  uint64_t from = 0, to = 0;
  bool operator==(const TickSpan&) const = default;
};

/// The user's marks on the time line: bookmarks (at most one per tick, ascending) and the span to
/// be looped.
struct TimeMarks {
  std::vector<Bookmark> bookmarks;
  std::optional<TickSpan> span;  ///< none: there is nothing to loop
  bool looping = false;

  /// Sets a bookmark at the tick, or removes the one that is there. An empty name becomes "mark N".
  void toggle(uint64_t tick, std::string name = {});
  void remove(size_t index);
  /// The nearest bookmark after, or before, a tick; null: none.
  const Bookmark* next(uint64_t tick) const;
  const Bookmark* previous(uint64_t tick) const;
  /// The span between the bookmarks around a tick; where there is none on a side, the span ends at
  /// `first` or `last`. None if it has no length.
  std::optional<TickSpan> span_about(uint64_t tick, uint64_t first, uint64_t last) const;
  /// Sets one end of the span. The other end moves if it would be on the wrong side.
  void begin_span(uint64_t tick, uint64_t last);
  void end_span(uint64_t tick, uint64_t first);
  bool operator==(const TimeMarks&) const = default;
};
inline const TimeMarks no_time_marks;

/// Times of the ticks of a run whose tick length may change. It knows the ticks it has seen; later
/// ones are assumed to be as long as the last one.
class TickClock {
 public:
  explicit TickClock(double tick_seconds) : parts_{{0, 0, tick_seconds}} {}

  /// Takes the moment shown. What was known of later ticks is dropped, since the run may take
  /// another course.
  void see(uint64_t tick, double time, double tick_seconds);
  double time_of(uint64_t tick) const;  ///< [s]
  /// The tick nearest to a time [s].
  uint64_t tick_at(double time) const;

 private:
  /// A range of ticks of equal length, up to the next part.
  struct Part {
    uint64_t tick = 0;
    double time = 0, tick_seconds = 0;
  };
  std::vector<Part> parts_;  ///< ascending; never empty
};
inline const TickClock usual_tick_clock{1.0 / 60};

}  // namespace tumble
