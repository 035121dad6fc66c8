#pragma once
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/dynamics/contact/pair_contacts.hpp"

#include <optional>
#include <span>

namespace tumble {

/// A pair at least one side of which is a dynamic body of several shapes. Known of such a pair is a
/// list of its shapes that are near each other, which stays valid until the bodies have moved
/// relative to each other by its spare range (a Verlet list); and for each pair of shapes in the
/// list, whether the two touched or how far apart they were. The narrow phase runs only on those
/// that may have come near since. Contacts, which may belong to several pairs of shapes
/// (shared_manifolds.hpp), are carried along while their own points hardly move relative to each
/// other.
class CompoundPair {
 public:
  CompoundPair(const PairContacts& finder, const PairSide& a, const PairSide& b,
               const PairHistory& history);

  /// Runs the narrow phase where it must. Returns true if the contacts are carried along; otherwise
  /// appends the manifolds. In both cases appends what is known of the pair from now on.
  bool look(Sights& sights);

 private:
  /// Whether everything that is known still holds, so that the narrow phase need not run at all.
  bool knows();
  const PairSide& side_a(const CachedShapes& piece);
  const PairSide& side_b(const CachedShapes& piece);
  const PairSide& side_of(const PairSide& whole, uint32_t shape, uint32_t& named,
                          PairSide& side) const;
  double reach_of(const CachedShapes& piece);
  /// Motion of the bodies relative to each other since one time.
  struct Motion {
    Pose since;   ///< relative_pose at that time
    double most;  ///< bound on the displacement of any point [m]
    std::optional<MotionSince> points;
  };
  Motion& motion_since(const Pose& then);
  const MotionSince& points_since(const Pose& then);
  double moved(const CachedShapes& piece);
  bool still_seen(const CachedShapes& piece);
  bool contacts_hold();
  bool find_whether_they_hold();
  void renew_list(Sights& sights);
  bool look_at_those_apart(std::span<CachedShapes> pieces);
  void look_at(CachedShapes& piece);

  const PairContacts& finder_;
  const PairSide &a_, &b_;
  const PairHistory& history_;
  Pose now_;  ///< relative_pose
  /// PairContacts::reach of the bodies: how far apart what touches within the tick may be [m]
  double reach_;
  /// How much farther the narrow phase searches, so that its result survives some motion [m]
  double slack_ = 0;
  std::optional<bool> hold_;           ///< contacts_hold, once asked for
  std::optional<Motion> motion_;       ///< the last one computed
  ShapesOfPair named_;                 ///< the shapes that side_of() was last asked for
  double asked_ = 0;                   ///< greatest margin with which the narrow phase ran [m]
  std::span<const uint64_t> pressed_;  ///< features of the points that pressed in the last tick
};

}  // namespace tumble
