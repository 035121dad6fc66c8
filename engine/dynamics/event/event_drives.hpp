#pragma once
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/dynamics/event/impulses/impact_law.hpp"
#include "engine/dynamics/joints/articulation.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// What acts along a joint coordinate by a law that is discontinuous in its rate, so that the force
/// follows from the other forces: a hard limit, a motor of limited force that holds a rate, dry
/// friction. Each is a step of a maximal monotone law (ForceLaw): while the rate differs from that
/// of the step the force is at one of its bounds; while the rate is held the force is anything
/// between.
struct DrivePart {
  enum class Kind : uint8_t { lower, upper, motor, friction };
  Kind kind = Kind::lower;
  uint32_t of = 0;         ///< index in EventDrives::coordinates()
  double most = 0;         ///< greatest force [N] or [N m]
  double restitution = 0;  ///< of a limit [-]

  // The mode, which stays through a step.
  bool holds = false;  ///< the limit is reached; the motor or friction keeps its rate
  /// Of a motor or friction that does not hold: sign of its rate less the held one.
  double side = 0;
  /// Accepted depth: how far the limit was passed at the beginning [m] or [rad].
  double offset = 0;
  int impacts = 0;   ///< collisions of a limit in this tick
  double force = 0;  ///< last found, along the coordinate [N] or [N m]

  bool limit() const { return kind == Kind::lower || kind == Kind::upper; }
  /// Sign of the rate that leads away from a limit.
  double inwards() const { return kind == Kind::lower ? 1 : -1; }
  /// Whether the force of a motor or friction is at a bound.
  bool saturated() const;
};

/// A joint coordinate with such parts, or with a motor of unlimited force.
struct DrivenCoordinate {
  uint32_t joint = 0;  ///< slot
  uint32_t place = 0;  ///< place of the joint in the group's list
  uint32_t coordinate = 0;
  std::array<uint32_t, 2> block_of{no_block, no_block};
  FollowedCoordinate known;  ///< value and rate at the beginning of the step
};

/// What acts along the coordinates of a group's joints other than smooth forces. Armatures and
/// motors of unlimited force are rows of the group's Articulation; everything else is a part here.
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
  /// The index of a part's row in JointImpulses.
  size_t row_of(const DrivePart& part) const;

  /// The row of a coordinate in the bodies' present state, `t` seconds after the tick began; its
  /// `error` is the value of the coordinate.
  JointRow look(uint32_t coordinate, std::span<const RigidBody> bodies, double t) const;
  double rate(const JointRow& row, uint32_t coordinate, std::span<const RigidBody> bodies) const;
  /// Updates all coordinates at the beginning of a step.
  void follow(std::span<const RigidBody> bodies, double t);

  /// Distance left to a limit, with its accepted depth [m] or [rad].
  double room(const DrivePart& limit, std::span<const RigidBody> bodies, double t) const;
  /// The rate less the one that a motor or friction aims at; of a limit, the rate away from it.
  double rate_off(const DrivePart& part, std::span<const RigidBody> bodies, double t) const;
  /// Rate of change of the rate that a part holds [m/s2] or [rad/s2].
  double change_held(const DrivePart& part) const;

  /// Sets the mode that the present state implies; limits that are being approached do not hold.
  void set_modes(std::span<const RigidBody> bodies, double t);
  /// Stops motors of unlimited force that drive into a limit that is reached.
  void stop_motors(std::span<const RigidBody> bodies, double t, Articulation& joints) const;
  /// Accepts the depth by which limits are passed now, less `worked_off`; returns whether any is
  /// passed.
  bool accept_depths(std::span<const RigidBody> bodies, double t, double worked_off);

  /// Adds the forces of motors and friction that do not hold to the accelerations, and fills `rows`
  /// with the rows of parts that hold, in the order of the parts.
  void act(std::span<const RigidBody> bodies, double t, std::span<DofBlock> accelerations,
           std::vector<BoundedRow>& rows);
  /// Stores the forces that were found for the rows of act().
  void take(std::span<const BoundedRow> rows);
  /// Calls f(const DrivePart&, const JointRow&) for each part with a force, with its row of the
  /// last act().
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
  std::vector<JointRow> now_;  ///< by coordinate, of the last act()
};

}  // namespace tumble
