#include "viewer/app/session/event_watch.hpp"

#include <algorithm>
#include <utility>

namespace tumble {

void EventWatch::see(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  std::vector<WorldEvent> events = gatherer_.see(frame);
  last_tick_ = frame.tick;
  if (events.empty()) return;
  log_.add(std::move(events));
  shown_.reset();
}

void EventWatch::go_to(const Frame& frame) {
  const std::lock_guard lock(mutex_);
  gatherer_.go_to(frame);
  log_.forget_after(frame.tick);
  last_tick_ = frame.tick;
  shown_.reset();
}

std::shared_ptr<const std::vector<WorldEvent>> EventWatch::events() const {
  const std::lock_guard lock(mutex_);
  if (!shown_) shown_ = std::make_shared<const std::vector<WorldEvent>>(log_.events());
  return shown_;
}

bool EventWatch::just_happened(const EventFilter& filter) const {
  const std::lock_guard lock(mutex_);
  const std::vector<WorldEvent>& all = log_.events();
  const auto first = std::ranges::lower_bound(all, last_tick_, {}, &WorldEvent::tick);
  return std::any_of(first, all.end(), [&](const WorldEvent& e) { return filter.takes(e); });
}

}  // namespace tumble
