#pragma once
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/joints/articulation.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// What acts along a coordinate of a joint by a law that jumps with its rate, so that its force
/// follows from all else that acts: a hard limit, a motor that holds a rate by a force up to a
/// greatest one, dry friction. Each is a step of a maximal monotone law (ForceLaw): where the rate
/// is off what the step is at, its force is one of its bounds; where it holds, anything between.
struct DrivePart {
  enum class Kind : uint8_t { lower, upper, motor, friction };
  Kind kind = Kind::lower;
  uint32_t of = 0;         ///< which of EventDrives' coordinates
  double most = 0;         ///< greatest force of a motor or friction [N] or [N m]
  double restitution = 0;  ///< of a limit [-]

  // The mode, which stays through a step.
  bool holds = false;  ///< a limit that is reached; a motor or friction that keeps its rate
  double side = 0;     ///< of a motor or friction that does not hold: sign of what the rate is off
  /// How far a limit is passed, which is accepted since it was so at the beginning [m] or [rad].
  double offset = 0;
  int impacts = 0;   ///< of a limit in this tick
  double force = 0;  ///< the last that was found, along the coordinate

  bool limit() const { return kind == Kind::lower || kind == Kind::upper; }
  /// The sign of the velocity that leads away from a limit.
  double inwards() const { return kind == Kind::lower ? 1 : -1; }
  /// Whether its force is at a bound.
  bool saturated() const;
};

/// A coordinate along which such parts act, or a motor of any strength.
struct DrivenCoordinate {
  uint32_t joint = 0;  ///< slot
  uint32_t place = 0;  ///< of the joint among those of the group
  uint32_t coordinate = 0;
  std::array<uint32_t, 2> block_of{no_block, no_block};
  FollowedCoordinate known;  ///< at the beginning of the step
};

/// What acts along coordinates of a group's joints and is no smooth force. Armatures and motors of
/// any strength are rows of its Articulation; all the rest are parts that are here.
class EventDrives {
 public:
  EventDrives() = default;
  EventDrives(std::span<const Joint> joints, std::span<const uint32_t> which,
              std::span<const uint32_t> block_of);

  bool empty() const { return coordinates_.empty(); }
  std::span<DrivePart> parts() { return parts_; }
  std::span<const DrivePart> parts() const { return parts_; }
  std::span<const DrivenCoordinate> coordinates() const { return coordinates_; }
  const DrivenCoordinate& coordinate_of(const DrivePart& part) const {
    return coordinates_[part.of];
  }
  /// The place of a part's row in JointImpulses.
  size_t row_of(const DrivePart& part) const;

  /// The row of a coordinate at the bodies' present state, `t` seconds since the tick began; its
  /// error is the value.
  JointRow look(uint32_t coordinate, std::span<const RigidBody> bodies, double t) const;
  double rate(const JointRow& row, uint32_t coordinate, std::span<const RigidBody> bodies) const;
  /// All coordinates at the beginning of a step.
  void follow(std::span<const RigidBody> bodies, double t);

  /// What is left of the way to a limit [m] or [rad].
  double room(const DrivePart& limit, std::span<const RigidBody> bodies, double t) const;
  /// The rate less what a motor or friction is at; of a limit the rate away from it.
  double rate_off(const DrivePart& part, std::span<const RigidBody> bodies, double t) const;
  /// The rate of a part's own change, which it holds where it holds [m/s2] or [rad/s2].
  double change_held(const DrivePart& part) const;

  /// The mode that goes with the present state; limits that are approached do not hold.
  void set_modes(std::span<const RigidBody> bodies, double t);
  /// Motors of any strength stand where they drive to a limit that is reached.
  void stop_motors(std::span<const RigidBody> bodies, double t, Articulation& joints) const;
  /// How far limits are passed by now is accepted, less so much; whether any is.
  bool accept_depths(std::span<const RigidBody> bodies, double t, double worked_off);

  /// Adds the forces of motors and friction that do not hold to accelerations, and gives the rows
  /// of what holds, in the order of the parts.
  void act(std::span<const RigidBody> bodies, double t, std::span<DofBlock> accelerations,
           std::vector<BoundedRow>& rows);
  /// Takes the forces that were found for these.
  void take(std::span<const BoundedRow> rows);
  /// Calls f(const DrivePart&, const JointRow&) for the parts with a force, the rows as of act().
  template <class F>
  void for_forces(const F& f) const {
    for (const DrivePart& p : parts_)
      if (p.force != 0) f(p, now_[p.of]);
  }

 private:
  const CoordinateDrive& drive_of(const DrivenCoordinate& c) const {
    return (*joints_[c.joint].drives)[c.coordinate];
  }
  void add_parts(uint32_t of);

  std::span<const Joint> joints_;
  std::vector<DrivenCoordinate> coordinates_;
  std::vector<DrivePart> parts_;
  std::vector<JointRow> now_;  ///< by coordinate, of act()
};

}  // namespace tumble
