#pragma once
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"

#include <span>
#include <vector>

namespace tumble {

/// Into how many equal parts the tick of a body is divided, with contacts found anew in each: 1,
/// unless meshes near each other move far in a tick compared with their thickness. Contacts found
/// at the start then say little about its end: a ring that turns by half its thickness touches at
/// other points. Convex shapes do not need it, as they have one surface from any side, unless the
/// tick is to be followed closely (RealtimeTick::close). At most settings.max_parts.
///
/// Bodies that may meet within the tick or are tied together, and so may act on each other, have
/// the same number: the greatest that any pair of them asks for. Nothing else affects it.
class TickParts {
 public:
  /// What the numbers depend on: the bodies at the start of a tick of `h` seconds, the active ones
  /// of them, pairs whose bounds overlap in the tick, and links between bodies.
  struct Tick {
    std::span<const RigidBody> bodies;
    std::span<const uint32_t> active;
    const ProxySet& proxies;
    std::span<const ProxyPair> pairs;
    std::span<const BodyLink> links;
    const ContactSet& contacts;
    double h;
    bool close = false;  ///< convex shapes count too
    double gravity = 0;  ///< magnitude; if `close`, what bodies gain by it counts as speed [m/s2]
  };
  void find(const Tick& tick, const RealtimeSettings& settings);

  /// The numbers of parts that occur, ascending; at least one.
  std::span<const int> numbers() const {
    static constexpr int one[] = {1};
    return numbers_.empty() ? std::span<const int>(one) : numbers_;
  }
  int greatest() const { return numbers().back(); }
  /// The number of a body; 0 for sleeping bodies far from all active ones, and for fixed ones.
  /// Undefined if only one number occurs.
  int of(uint32_t slot) const { return of_[slot]; }
  /// Bodies without a number that are active now were woken by bodies of this number.
  void take_in(std::span<const uint32_t> active, int number);

 private:
  void spread(const Tick& tick, std::span<const int> asked);
  std::vector<int> numbers_;  ///< empty: 1 for all
  std::vector<int> of_;       ///< by slot
};

/// The settings for one of `parts` parts of a tick: the length of sub-steps stays the same.
RealtimeSettings part_settings(const RealtimeSettings& settings, int parts);

}  // namespace tumble
