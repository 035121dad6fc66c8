#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// A value that is positive before an event, which happens where it crosses 0.
struct WatchedValue {
  enum class Kind : uint8_t {
    gap,       ///< distance of two surface elements, with accepted depth [m]
    slip,      ///< of a sliding contact, along its direction at the start [m/s]
    limit,     ///< distance to a joint limit [m] or [rad]
    rate,      ///< of a joint's motor or friction: rate less the one it aims at [m/s] or [rad/s]
    rolling,   ///< along its axis at the start [rad/s]
    spinning,  ///< likewise [rad/s]
    pieces,    ///< distance of pieces of shapes to the greatest allowed depth [m]
  };
  Kind kind = Kind::gap;
  uint32_t a = ~uint32_t{0}, b = ~uint32_t{0};  ///< slots of bodies; none for joints
  Vec3 x_world = Vec3::Zero();                  ///< at the start of the step; 0 for joints [m]
};

/// A value that was computed in the search.
struct SearchLook {
  enum class Stage : uint8_t {
    start,  ///< at the start of the step
    /// Shortly after it: a gap that has just opened must first grow before it can close again.
    parted,
    look,  ///< at one of a few equal times through the step
    root,  ///< in the search for the root between two times that bracket an event
  };
  double time = 0;     ///< since the start of the step [s]
  uint32_t value = 0;  ///< index in EventSearch::watched
  double f = 0;        ///< the value
  Stage stage = Stage::look;
  /// The interval in which the event is then known to lie, since the start of the step [s]
  double low = 0, high = 0;
  Pose pose;  ///< of the traced body at that time
};

/// The search for the first event in one step of an integrator.
struct EventSearch {
  static constexpr int none = -1;
  /// The step begins at `begin` after the start of the tick and lasts `step` [s]
  double begin = 0, step = 0;
  double found = 0;  ///< since the start of the step; `step` if there is no event [s]
  int first = none;  ///< index in `watched` of the first event
  std::vector<WatchedValue> watched;
  std::vector<SearchLook> looks;
};

/// All searches of a tick for the group of one body; those of parts of the tick that were undone
/// are left out.
struct EventSearchTrace {
  uint32_t body = ~uint32_t{0};  ///< slot
  std::vector<EventSearch> searches;
  /// Greatest number of searches that are kept, and how many more there were.
  size_t most = 500, left_out = 0;

  /// Begins a new search; null when there are too many.
  EventSearch* begin(double begin, double step) {
    while (!searches.empty() && searches.back().begin > begin) searches.pop_back();
    if (searches.size() >= most) {
      ++left_out;
      return nullptr;
    }
    searches.push_back({begin, step, step, EventSearch::none, {}, {}});
    return &searches.back();
  }
};

}  // namespace tumble
