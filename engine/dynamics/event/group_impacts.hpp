#pragma once
#include "engine/dynamics/event/group_projection.hpp"

namespace tumble {

/// What happens to a group at one moment: collisions, impulses where no forces exist (jams), and
/// which contacts are closed and slide from then on.
class GroupImpacts {
 public:
  GroupImpacts(GroupState& state, GroupProjection& projection)
      : state_(state), projection_(projection), drives_(state) {}

  /// Resolves collisions, closes resting contacts, and projects velocities and positions.
  Status resolve(EventStats& stats);
  /// Applies an impulse of the joints where velocities violate joints or motors of unlimited force,
  /// because bodies on courses begin to move or motors start.
  void start_joints(EventStats& stats);
  /// Applies impulses that stop slip where no finite forces exist. False if none do.
  bool stop_jams(EventStats& stats);

 private:
  /// Resolves the collision of these contacts and limits of joints.
  Status collide(std::span<const size_t> touching, std::span<const size_t> limits,
                 EventStats& stats);
  void take_impulses(std::span<const size_t> touching, const ImpactReport& report,
                     EventStats& stats);
  void close_contacts();
  /// Decides whether a closed contact slides, and in which direction.
  void find_slip(EventContact& contact, const ElementGap& gap) const;
  void book_impulses(std::span<const ImpactPoint> points, std::span<const Vec3> impulses,
                     std::span<const double> joint_impulses, std::span<const DofBlock> after);

  GroupState& state_;
  GroupProjection& projection_;
  GroupDrives drives_;
};

}  // namespace tumble
