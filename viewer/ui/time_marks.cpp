#include "viewer/ui/time_marks.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace tumble {
namespace {

/// The first "mark N" that is not taken.
std::string free_mark_name(const std::vector<Bookmark>& bookmarks) {
  for (size_t n = bookmarks.size() + 1;; ++n) {
    std::string name = fmt::format("mark {}", n);
    if (std::ranges::find(bookmarks, name, &Bookmark::name) == bookmarks.end()) return name;
  }
}

}  // namespace

void TimeMarks::toggle(uint64_t tick, std::string name) {
  const auto at = std::ranges::lower_bound(bookmarks, tick, {}, &Bookmark::tick);
  if (at != bookmarks.end() && at->tick == tick) {
    bookmarks.erase(at);
    return;
  }
  if (name.empty()) name = free_mark_name(bookmarks);
  bookmarks.insert(at, {tick, std::move(name)});
}

void TimeMarks::remove(size_t index) {
  if (index < bookmarks.size()) bookmarks.erase(bookmarks.begin() + std::ptrdiff_t(index));
}

const Bookmark* TimeMarks::next(uint64_t tick) const {
  const auto at = std::ranges::upper_bound(bookmarks, tick, {}, &Bookmark::tick);
  return at == bookmarks.end() ? nullptr : &*at;
}

const Bookmark* TimeMarks::previous(uint64_t tick) const {
  const auto at = std::ranges::lower_bound(bookmarks, tick, {}, &Bookmark::tick);
  return at == bookmarks.begin() ? nullptr : &*std::prev(at);
}

std::optional<TickSpan> TimeMarks::span_about(uint64_t tick, uint64_t first, uint64_t last) const {
  // With a bookmark at this tick, the span before it is meant.
  const Bookmark* before = previous(tick);
  const auto at = std::ranges::lower_bound(bookmarks, tick, {}, &Bookmark::tick);
  TickSpan span{before ? before->tick : first, at != bookmarks.end() ? at->tick : last};
  if (span.from < span.to) return span;
  return std::nullopt;
}

void TimeMarks::begin_span(uint64_t tick, uint64_t last) {
  const uint64_t to = span && span->to > tick ? span->to : std::max(last, tick + 1);
  span = TickSpan{tick, to};
}

void TimeMarks::end_span(uint64_t tick, uint64_t first) {
  const uint64_t to = std::max<uint64_t>(tick, 1);
  const uint64_t from = span && span->from < to ? span->from : std::min(first, to - 1);
  span = TickSpan{from, to};
}

void TickClock::see(uint64_t tick, double time, double tick_seconds) {
  while (parts_.size() > 1 && parts_.back().tick >= tick) parts_.pop_back();
  const Part& last = parts_.back();
  if (last.tick_seconds != tick_seconds || std::abs(time_of(tick) - time) > 0.5 * tick_seconds)
    parts_.push_back({tick, time, tick_seconds});
}

double TickClock::time_of(uint64_t tick) const {
  const auto next = std::ranges::upper_bound(parts_, tick, {}, &Part::tick);
  const Part& part = *std::prev(next);
  const double time = part.time + double(tick - part.tick) * part.tick_seconds;
  return next == parts_.end() ? time : std::min(time, next->time);
}

uint64_t TickClock::tick_at(double time) const {
  const auto next = std::ranges::upper_bound(parts_, time, {}, &Part::time);
  const Part& part = next == parts_.begin() ? *next : *std::prev(next);
  const double ticks = std::max((time - part.time) / part.tick_seconds, 0.0);
  const uint64_t tick = part.tick + uint64_t(std::llround(std::min(ticks, 1e15)));
  return next == parts_.end() ? tick : std::min(tick, next->tick);
}

}  // namespace tumble
