#pragma once
#include "engine/dynamics/contact/cached_pair.hpp"
#include "engine/dynamics/contact/pair_contacts.hpp"

#include <optional>
#include <span>

namespace tumble {

/// A pair of which at least one side is a body of several shapes. What is known of them is a list
/// of all pairs of shapes that are near each other, which stays good until the bodies have moved
/// against each other by what it reaches beyond; and of each such pair, whether it touched or how
/// far it was apart. Only those that may have come near since are looked at. Contacts, which shapes
/// share (shared_manifolds.hpp), are carried along while their own points hardly move against each
/// other.
class CompoundPair {
 public:
  CompoundPair(const PairContacts& finder, const PairSide& a, const PairSide& b,
               const PairHistory& history);

  /// Has the narrow phase look where it must. Whether contacts are carried along; else appends the
  /// manifolds. Appends what is known now.
  bool look(Sights& sights);

 private:
  /// Whether all that is known still holds.
  bool knows();
  const PairSide& side_a(const CachedShapes& piece);
  const PairSide& side_b(const CachedShapes& piece);
  const PairSide& side_of(const PairSide& whole, uint32_t shape, uint32_t& named,
                          PairSide& side) const;
  double reach_of(const CachedShapes& piece);
  /// Of the bodies against each other.
  struct Motion {
    Pose since;   ///< relative_pose then
    double most;  ///< bound on the way of any point [m]
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
  Pose now_;                           ///< relative_pose
  double reach_;                       ///< PairContacts::reach of the bodies [m]
  double slack_ = 0;                   ///< what is asked for beyond it, good for some motion [m]
  std::optional<bool> hold_;           ///< contacts_hold, once asked for
  std::optional<Motion> motion_;       ///< the last that was asked for
  ShapesOfPair named_;                 ///< the shapes that were asked for last
  double asked_ = 0;                   ///< greatest margin that shapes were looked at with [m]
  std::span<const uint64_t> pressed_;  ///< features
};

}  // namespace tumble
