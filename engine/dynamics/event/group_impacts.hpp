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
  /// Velocities that joints and motors of any strength do not allow (bodies on courses begin to
  /// move, motors start) end by impulses.
  void start_joints(EventStats& stats);
  /// Where there are no finite forces: impulses that stop slip. False when none do.
  bool stop_jams(EventStats& stats);

 private:
  /// Of contacts, and of limits of joints.
  Status collide(std::span<const size_t> touching, std::span<const size_t> limits,
                 EventStats& stats);
  void take_impulses(std::span<const size_t> touching, const ImpactReport& report,
                     EventStats& stats);
  void close_contacts();
  /// Whether a closed contact slides, and where to.
  void find_slip(EventContact& contact, const ElementGap& gap) const;
  void book_impulses(std::span<const ImpactPoint> points, std::span<const Vec3> impulses,
                     std::span<const double> joint_impulses, std::span<const DofBlock> after);

  GroupState& state_;
  GroupProjection& projection_;
  GroupDrives drives_;
};

}  // namespace tumble
