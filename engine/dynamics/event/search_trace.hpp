#pragma once
#include "engine/math/types.hpp"

#include <cstdint>
#include <vector>

namespace tumble {

/// A value that is positive before an event, which comes where it crosses 0.
struct WatchedValue {
  enum class Kind : uint8_t {
    gap,       ///< what is left until two surface elements touch [m]
    slip,      ///< of a sliding contact, along itself [m/s]
    limit,     ///< of a joint, what is left until it is reached [m] or [rad]
    rate,      ///< of a joint's motor or friction, off the rate it would have [m/s] or [rad/s]
    rolling,   ///< along itself [rad/s]
    spinning,  ///< likewise [rad/s]
    pieces,    ///< of shapes, what is left until they are deeper than allowed [m]
  };
  Kind kind = Kind::gap;
  uint32_t a = ~uint32_t{0}, b = ~uint32_t{0};  ///< slots of bodies; none for joints
  Vec3 x_world = Vec3::Zero();                  ///< at the start of the step; 0 for joints [m]
};

/// A value at a time that was tried.
struct SearchLook {
  enum class Stage : uint8_t {
    start,   ///< of the step
    parted,  ///< shortly after it: what has just parted must first be away before it can come back
    look,    ///< one of a few through the step
    root,    ///< between the two that bracket an event
  };
  double time = 0;     ///< since the start of the step [s]
  uint32_t value = 0;  ///< place in EventSearch::watched
  double f = 0;        ///< the value
  Stage stage = Stage::look;
  double low = 0, high = 0;  ///< between which times the event is known to be after it [s]
  Pose pose;                 ///< of the body that is looked at, then
};

/// The search for the first event in one step of an integrator.
struct EventSearch {
  static constexpr int none = -1;
  double begin = 0, step = 0;  ///< the step, from so long after the start of the tick on [s]
  double found = 0;            ///< since the start of the step; `step` if there is no event [s]
  int first = none;            ///< place in `watched` of what comes first
  std::vector<WatchedValue> watched;
  std::vector<SearchLook> looks;
};

/// All searches of a tick of the group that a body is in, as the event stepper goes; those of parts
/// of the tick that were given up are not among them.
struct EventSearchTrace {
  uint32_t body = ~uint32_t{0};  ///< slot
  std::vector<EventSearch> searches;
  size_t most = 500, left_out = 0;  ///< searches that are kept, and that were not

  /// A new one, or null when there are too many.
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
