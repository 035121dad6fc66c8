#pragma once
#include "engine/dynamics/event/group_state.hpp"

namespace tumble {

/// What acts along the coordinates of a group's joints, at one moment: limits that are reached, and
/// what holds from then on.
class GroupDrives {
 public:
  explicit GroupDrives(GroupState& state) : state_(state) {}

  /// See EventDrives::accept_depths().
  bool accept_depths(double worked_off) {
    return drives().accept_depths(state_.bodies, state_.system.now(), worked_off);
  }
  /// From here on angles are counted, and steps begin. Rows of joints whose rate is off, and those
  /// of motors of any strength, get it by an impulse; such motors stand where they would drive
  /// beyond a limit. Gives these impulses by row of the joints, empty if there are none, and the
  /// velocities then.
  std::vector<double> start_joints(std::vector<DofBlock>& moving);
  /// Limits that are reached, by part.
  std::vector<size_t> touching() const;
  /// Whether any of these is approached so fast that it collides.
  bool hit(std::span<const size_t> touching) const;
  /// Points of a collision, behind those that are there, of limits that are reached; counts impacts
  /// of those that are approached. Gives the fastest approach of any [m/s, rad/s].
  double add_points(std::span<const size_t> touching, std::vector<ImpactPoint>& points);
  /// The mode that goes with the velocities.
  void set_modes() { drives().set_modes(state_.bodies, state_.system.now()); }

  /// Rows whose velocity must be another one, and by how much: of what holds with less than all of
  /// its force.
  void add_velocities(std::vector<Row>& rows, std::vector<double>& wanted) const;
  /// Likewise of displacements: of limits that hold or are passed.
  void add_positions(std::vector<Row>& rows, std::vector<double>& wanted) const;
  /// Whether what holds under a force is still where it should be.
  bool kept() const;

 private:
  EventDrives& drives() const { return state_.system.drives(); }
  double room(const DrivePart& p) const {
    return drives().room(p, state_.bodies, state_.system.now());
  }
  double rate_off(const DrivePart& p) const {
    return drives().rate_off(p, state_.bodies, state_.system.now());
  }
  Row row(const DrivePart& p) const {
    return drives().look(p.of, state_.bodies, state_.system.now()).row;
  }
  /// Whether a series of bounces comes to its end within the tick (Zeno).
  bool ends_series(const DrivePart& limit, double approach) const;

  GroupState& state_;
};

}  // namespace tumble
