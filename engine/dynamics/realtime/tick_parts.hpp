#pragma once
#include "engine/dynamics/bodies/proxies.hpp"
#include "engine/dynamics/contact/contact_set.hpp"
#include "engine/dynamics/islands/islands.hpp"
#include "engine/dynamics/realtime/realtime_settings.hpp"

#include <span>
#include <vector>

namespace tumble {

/// In how many equal parts the tick of a body is taken, contacts being found anew in each: 1,
/// unless meshes near each other move far in a tick for how thin they are. The contacts found at
/// the start then say little about its end: a ring that spins by half its gauge has other points
/// in touch. Convex shapes do without, since from any side they have one surface, unless the tick
/// is to be followed closely (RealtimeTick::close). At most settings.max_parts.
///
/// Bodies that may meet within the tick or are tied together, and so all that may act on each
/// other, have the same number: the greatest that two of them ask for. Nobody else has a say in it.
class TickParts {
 public:
  /// What the numbers follow from: the bodies at the start of a tick of `h` seconds, those of them
  /// that are active, the pairs whose bounds meet in it, and what ties bodies together.
  struct Tick {
    std::span<const RigidBody> bodies;
    std::span<const uint32_t> active;
    const ProxySet& proxies;
    std::span<const ProxyPair> pairs;
    std::span<const BodyLink> links;
    const ContactSet& contacts;
    double h;
    bool close = false;  ///< convex shapes count too
    double gravity = 0;  ///< magnitude, by which these gain speed [m/s2]
  };
  void find(const Tick& tick, const RealtimeSettings& settings);

  /// The numbers of parts that occur, ascending; at least one.
  std::span<const int> numbers() const {
    static constexpr int one[] = {1};
    return numbers_.empty() ? std::span<const int>(one) : numbers_;
  }
  int greatest() const { return numbers().back(); }
  /// Of a body; 0 where it sleeps far from all that is active, and of what is fixed. Where there is
  /// one number only nothing else is known.
  int of(uint32_t slot) const { return of_[slot]; }
  /// Bodies without a number that are active now were woken by bodies of this number.
  void take_in(std::span<const uint32_t> active, int number);

 private:
  void spread(const Tick& tick, std::span<const int> asked);
  std::vector<int> numbers_;  ///< none: 1 for all
  std::vector<int> of_;       ///< by slot
};

/// The settings for one of `parts` parts: sub-steps stay as long as they were.
RealtimeSettings part_settings(const RealtimeSettings& settings, int parts);

}  // namespace tumble
