#pragma once
#include "engine/world/events/gather_events.hpp"
#include "viewer/app/scenes/tick_watcher.hpp"

#include <memory>
#include <mutex>
#include <vector>

namespace tumble {

/// Keeps the list of events in a session's world.
class EventWatch final : public TickWatcher {
 public:
  void see(const Frame& frame) override;
  void go_to(const Frame& frame) override;

  /// All known events by tick; the same list object as long as nothing has happened.
  std::shared_ptr<const std::vector<WorldEvent>> events() const;
  /// Whether an event that passes the filter happened in the last tick seen.
  bool just_happened(const EventFilter& filter) const;

 private:
  mutable std::mutex mutex_;
  EventGatherer gatherer_;
  EventLog log_;
  uint64_t last_tick_ = 0;
  mutable std::shared_ptr<const std::vector<WorldEvent>> shown_;  ///< null: out of date
};

}  // namespace tumble
