#pragma once
#include "engine/world/events/gather_events.hpp"
#include "viewer/app/scenes/tick_watcher.hpp"

#include <memory>
#include <mutex>
#include <vector>

namespace tumble {

/// Keeps the list of what happens in a session's world.
class EventWatch final : public TickWatcher {
 public:
  void see(const Frame& frame) override;
  void go_to(const Frame& frame) override;

  /// All that it knows of, by tick; the same list until something has happened.
  std::shared_ptr<const std::vector<WorldEvent>> events() const;
  /// Whether something that the filter takes happened in the last tick that was seen.
  bool just_happened(const EventFilter& filter) const;

 private:
  mutable std::mutex mutex_;
  EventGatherer gatherer_;
  EventLog log_;
  uint64_t last_tick_ = 0;
  mutable std::shared_ptr<const std::vector<WorldEvent>> shown_;  ///< null: out of date
};

}  // namespace tumble
