#pragma once
#include "engine/dynamics/event/group_drives.hpp"

namespace tumble {

/// How far joints were off before GroupProjection::hold_joints() corrected them.
struct JointDrift {
  double open = 0;     ///< how far joints had come open [m, rad]
  double changed = 0;  ///< kinetic energy of the correction of velocities [J]
};

/// Removes, by the least change, errors of velocities and positions that a step or an event left at
/// closed contacts and joints, and books the effects.
class GroupProjection {
 public:
  explicit GroupProjection(GroupState& state) : state_(state), drives_(state) {}

  void project();
  /// Corrects the joints alone, so that what follows starts from bodies that satisfy them. The
  /// displacement is booked under `cause`.
  JointDrift hold_joints(ContactCause cause = ContactCause::projection);
  /// Work off overlap, and errors of joints, that existed before; see
  /// EventSettings::recovery_speed.
  void work_off_overlap();
  void work_off_openings();
  /// Kinetic energy relative to the common centre of mass [J].
  double inner_energy() const;

 private:
  /// Removes normal velocities at closed contacts, slip at sticking ones, and turning that is held
  /// at zero.
  void project_velocities();
  /// Corrects the positions of contacts once; returns the greatest error that it found [m].
  double project_positions(ContactCause cause);
  /// Repeats project_positions() until no error is left.
  void close_up(ContactCause cause = ContactCause::projection);
  void move_bodies(std::span<const DofBlock> displacements,
                   ContactCause cause = ContactCause::projection);
  /// Appends the rows of turning that is held at zero, with the wanted change.
  void add_turning(std::vector<Row>& rows, std::vector<double>& wanted) const;
  Row row_at(const EventContact& contact, const ElementGap& gap, const Vec3& axis) const;
  /// Books a change of velocities; returns the kinetic energy of the change alone [J].
  double book(std::span<const DofBlock> after);

  GroupState& state_;
  GroupDrives drives_;
  std::vector<DofBlock> moving_;  ///< scratch memory of hold_joints()
  std::vector<double> pushes_;
};

}  // namespace tumble
