#pragma once
#include "engine/dynamics/event/cause_effects.hpp"
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/slow_slip.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Where two shapes touch in a point or along a line, and their materials resist turning there:
/// rolling friction about axes in the tangent plane, torsional friction about the normal. Both are
/// torques of no more than a lever arm times the normal force of all points there (Coulomb's law
/// of rolling friction): against the turning where there is some, and what keeps it at none where
/// that is enough (Leine & van de Wouw 2008, ch. 5). Three points span a patch, which resists
/// turning by the places of its forces; as in the realtime stepper it has no torque besides.
struct TurningPart {
  std::array<uint32_t, 2> contacts{};  ///< closed ones
  uint32_t count = 0;                  ///< of these
  double rolling = 0, torsional = 0;   ///< lever arms, combined [m]

  // The mode, which stays through a step.
  Vec3 axis = Vec3::Zero();  ///< unit, along the rolling at the start of the step; 0: held at none
  double spin = 0;           ///< sign of the spinning about the normal; 0: held at none
  double foresight = 0;      ///< slip_foresight() of the rolling [s]

  Vec3 torque = Vec3::Zero();  ///< on B, the last found, world axes [N m]

  bool rolls() const { return !axis.isZero(0); }
};

/// Of B against A, in parts along the tangent plane and about the normal.
struct Turning {
  Vec3 normal = Vec3::UnitY(), rolling = Vec3::Zero();  ///< [rad/s]
  double spinning = 0;                                  ///< [rad/s]
};
Turning turning_of(const TurningPart& part, std::span<const EventContact> contacts,
                   std::span<const RigidBody> bodies);

/// Those of closed contacts, with the mode that goes with the bodies' velocities. Materials that
/// name no lever arm have none here: the half a millimetre that is theirs by default is a guess.
std::vector<TurningPart> turning_parts(std::span<const EventContact> contacts,
                                       std::span<const RigidBody> bodies);

/// The torques of a group's contacts within the equations of motion.
class EventTurning {
 public:
  void set(std::span<const EventContact> contacts, std::span<const RigidBody> bodies);
  std::span<const TurningPart> parts() const { return parts_; }

  /// The unknowns that go with the contacts `acting`, in their order, whose points are `points`.
  void act(std::span<EventContact* const> acting, std::span<const ForcePoint> points);
  std::span<TurningPoint> points() { return points_; }
  /// Keeps the torques that were found.
  void take();
  void book(ContactEffects& out) const;

  /// Slow rolling is stiff as slow slip is, and looks ahead as that does, see slip_foresight(); h
  /// is the step, and the bodies are where it begins.
  bool stiff(double h) const;
  void foresee(double h, std::span<const DofBlock> accelerations);
  void forget_foresight();
  bool foresees() const;
  /// Rolling friction that would stop the rolling before the time it looks ahead to is that of the
  /// rolling as it is. Whether there was any, in forces `found` by point.
  bool end_foresight(bool solved, std::span<const ForcePoint> points, std::span<const Vec3> found);

 private:
  SlipForesight rolling_foresight(const TurningPart& part, double h) const;

  std::span<const EventContact> contacts_;
  std::span<const RigidBody> bodies_;
  std::vector<TurningPart> parts_;
  std::vector<TurningPoint> points_;
  std::vector<size_t> part_of_;  ///< of a point
};

}  // namespace tumble
