#include "engine/world/events/world_event.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr std::array<std::string_view, world_event_kinds> kind_names = {
    "impact", "joint broken", "fell asleep", "woke", "births", "deaths", "time-stepped"};

bool holds_part(const std::string& text, const std::string& part) {
  const auto same = [](unsigned char a, unsigned char b) {
    return std::tolower(a) == std::tolower(b);
  };
  return std::search(text.begin(), text.end(), part.begin(), part.end(), same) != text.end();
}

}  // namespace

std::string_view event_kind_name(WorldEventKind kind) {
  return kind_names[size_t(kind)];
}

std::string event_text(const WorldEvent& e) {
  switch (e.kind) {
    case WorldEventKind::impact:
      return fmt::format("{} against {}, {:.3g} N s", e.name_a, e.name_b, e.impulse);
    case WorldEventKind::time_stepped:
      return fmt::format("{} group{}", e.count, e.count == 1 ? "" : "s");
    default:
      break;
  }
  return e.count == 1 ? e.name_a : fmt::format("{} of {} ...", e.count, e.name_a);
}

bool EventFilter::takes(const WorldEvent& e) const {
  if (kind && e.kind != *kind) return false;
  if (e.kind == WorldEventKind::impact && e.impulse < least_impulse) return false;
  return body.empty() || holds_part(e.name_a, body) || holds_part(e.name_b, body);
}

void EventLog::add(std::vector<WorldEvent> events) {
  std::ranges::move(events, std::back_inserter(events_));
  if (events_.size() <= most) return;
  // Drops a tenth at once, so that this is rare.
  events_.erase(events_.begin(), events_.end() - std::ptrdiff_t(most - most / 10));
}

void EventLog::forget_after(uint64_t tick) {
  std::erase_if(events_, [tick](const WorldEvent& e) { return e.tick > tick; });
}

}  // namespace tumble
