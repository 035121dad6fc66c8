#pragma once
#include "engine/dynamics/event/group_drives.hpp"

namespace tumble {

/// What GroupProjection::hold_joints() put right.
struct JointDrift {
  double open = 0;     ///< how far joints had come open [m, rad]
  double changed = 0;  ///< kinetic energy of the change of velocities [J]
};

/// Puts right what a step or an event left of velocities and positions that closed contacts and
/// joints do not have, by the least change, and books what it does.
class GroupProjection {
 public:
  explicit GroupProjection(GroupState& state) : state_(state), drives_(state) {}

  void project();
  /// Puts the joints right by themselves; what happens then begins with bodies that they hold.
  /// `cause` is that of displacements.
  JointDrift hold_joints(ContactCause cause = ContactCause::projection);
  /// What was there before of overlap, and of joints that do not fit, is worked off; see
  /// EventSettings::recovery_speed.
  void work_off_overlap();
  void work_off_openings();
  /// Kinetic energy of all bodies about their common centre of mass.
  double inner_energy() const;

 private:
  /// Velocities that closed contacts and those that stick do not have.
  void project_velocities();
  /// Gives how far the contact was off that was farthest off [m].
  double project_positions(ContactCause cause);
  /// project_positions() until nothing is off.
  void close_up(ContactCause cause = ContactCause::projection);
  void move_bodies(std::span<const DofBlock> displacements,
                   ContactCause cause = ContactCause::projection);
  /// Turning that is held at none, and what must become of it.
  void add_turning(std::vector<Row>& rows, std::vector<double>& wanted) const;
  Row row_at(const EventContact& contact, const ElementGap& gap, const Vec3& axis) const;
  /// Gives the kinetic energy of the change.
  double book(std::span<const DofBlock> after);

  GroupState& state_;
  GroupDrives drives_;
  std::vector<DofBlock> moving_;  ///< of hold_joints()
  std::vector<double> pushes_;
};

}  // namespace tumble
