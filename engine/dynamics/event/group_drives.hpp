#pragma once
#include "engine/dynamics/event/group_state.hpp"

namespace tumble {

/// The drive parts of a group at one moment: limits that are reached and collide, and which parts
/// hold from then on.
class GroupDrives {
 public:
  explicit GroupDrives(GroupState& state) : state_(state) {}

  /// See EventDrives::accept_depths().
  bool accept_depths(double worked_off) {
    return drives().accept_depths(state_.bodies, state_.system.now(), worked_off);
  }
  /// Begins counting of angles, and of steps. Rows of joints whose rate is wrong, motors of
  /// unlimited force among them, get their rate by an impulse; such motors stop where they would
  /// drive beyond a limit. Returns these impulses by row of the joints, empty if none are needed;
  /// `moving` are then the velocities after them.
  std::vector<double> start_joints(std::vector<DofBlock>& moving);
  /// The limits that are reached, by index of part.
  std::vector<size_t> touching() const;
  /// Whether any of these is approached fast enough to collide.
  bool hit(std::span<const size_t> touching) const;
  /// Appends points of a collision for limits that are reached; counts an impact for those that are
  /// approached. Returns the fastest approach [m/s, rad/s].
  double add_points(std::span<const size_t> touching, std::vector<ImpactPoint>& points);
  /// Sets the mode that the present velocities imply.
  void set_modes() { drives().set_modes(state_.bodies, state_.system.now()); }

  /// Appends rows whose velocity must change, and by how much: of parts that hold with a force
  /// within its bounds.
  void add_velocities(std::vector<Row>& rows, std::vector<double>& wanted) const;
  /// The same for displacements: of limits that hold or are passed.
  void add_positions(std::vector<Row>& rows, std::vector<double>& wanted) const;
  /// Whether parts that hold under load still have their rate and place.
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
  /// Whether a series of bounces at a limit ends within the tick (Zeno).
  bool ends_series(const DrivePart& limit, double approach) const;

  GroupState& state_;
};

}  // namespace tumble
