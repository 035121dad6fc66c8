#pragma once
#include "engine/dynamics/event/group_projection.hpp"

namespace tumble {

/// What happens to a group at one moment: collisions, slip that no force can stop, and which
/// contacts are closed and which of them slide from then on.
class GroupImpacts {
 public:
  GroupImpacts(GroupState& state, GroupProjection& projection)
      : state_(state), projection_(projection), drives_(state) {}

  /// Resolves what collides, closes what rests, and puts right what is left.
  Status resolve(EventStats& stats);
  /// Where there are no finite forces: impulses that stop slip; or else, the slowest slip that
  /// contact forces in the full cone hold comes to rest. False when nothing does it.
  bool stop_slip(EventStats& stats) { return stop_jams(stats) || stop_slowest(stats); }

 private:
  void start_motors(EventStats& stats);
  /// Of contacts, and of limits of joints.
  Status collide(std::span<const size_t> touching, std::span<const size_t> limits,
                 EventStats& stats);
  bool stop_jams(EventStats& stats);
  bool stop_slowest(EventStats& stats);
  void take_impulses(std::span<const size_t> touching, const ImpactReport& report,
                     EventStats& stats);
  void close_contacts();
  /// Whether a closed contact slides, and where to.
  void find_slip(EventContact& contact, const ElementGap& gap) const;
  /// Slower than this is at rest where forces hold it [m/s]: still_speed, but where impacts and
  /// ends of slip crowd (more than 20 in a tick, and one for every four contacts) twice that with
  /// each further one, up to gravity * tick / 8. Bodies that touch at many points rattle: a hit at
  /// one opens others by nanometres, and so on (Zeno).
  double resting_speed() const;
  /// Closes contacts and stops slip that are slower than resting_speed(), where the contact forces
  /// press them and hold them within the cone: what these would stop within the tick stops at once.
  /// What opens or slips by these forces goes on. The least change of velocities does it, which
  /// takes energy: booked to restitution along the normals, then to friction.
  void rest_slow();
  /// Brings to rest what is newly marked as closed or sticking, where the contact forces keep it
  /// so. False, with velocities as they were, when they keep none of it.
  bool rest_marked(std::span<const EventContact> before);
  /// Marks what moves slower than `slow` as closed and sticking; whether there is any.
  bool mark_slow(double slow);
  /// Undoes the marks of what the forces at `before` do not hold.
  bool unmark_loose(std::span<const EventContact> before);
  void book_impulses(std::span<const ImpactPoint> points, std::span<const Vec3> impulses,
                     std::span<const double> joint_impulses, std::span<const DofBlock> after);

  GroupState& state_;
  GroupProjection& projection_;
  GroupDrives drives_;
};

}  // namespace tumble
