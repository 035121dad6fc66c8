#pragma once
#include "engine/dynamics/event/cause_effects.hpp"
#include "engine/dynamics/event/contact_forces.hpp"
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/slow_slip.hpp"

#include <array>
#include <span>
#include <vector>

namespace tumble {

/// Rolling and torsional friction where two shapes touch in a point or along a line: rolling
/// friction is a torque about an axis in the tangent plane, torsional friction about the normal.
/// Each is at most a lever arm times the normal force of all points there (Coulomb's law of rolling
/// friction): it opposes the turning, or holds it at zero where that needs no more (Leine & van de
/// Wouw 2008, ch. 5). Three or more points span a patch, which resists turning by where its forces
/// act; as in the realtime stepper it has no such torque.
struct TurningPart {
  std::array<uint32_t, 2> contacts{};  ///< indices of closed contacts
  uint32_t count = 0;                  ///< number of these
  double rolling = 0, torsional = 0;   ///< lever arms, combined of both materials [m]

  // The mode, which stays through a step.
  Vec3 axis = Vec3::Zero();  ///< unit, along the rolling at the start of the step; 0: held at zero
  double spin = 0;           ///< sign of the spinning about the normal; 0: held at zero
  double foresight = 0;      ///< slip_foresight() for the rolling [s]

  Vec3 torque = Vec3::Zero();  ///< on B, last found, world axes [N m]

  bool rolls() const { return !axis.isZero(0); }
};

/// Angular velocity of B relative to A, split into rolling (tangential) and spinning (normal).
struct Turning {
  Vec3 normal = Vec3::UnitY(), rolling = Vec3::Zero();  ///< [rad/s]
  double spinning = 0;                                  ///< [rad/s]
};
Turning turning_of(const TurningPart& part, std::span<const EventContact> contacts,
                   std::span<const RigidBody> bodies);

/// The parts of all closed contacts, with the mode that the bodies' velocities imply. A material
/// acts here only if it, or the one that it touches, names a lever arm: the default of half a
/// millimetre is a guess.
std::vector<TurningPart> turning_parts(std::span<const EventContact> contacts,
                                       std::span<const RigidBody> bodies);

/// The torques of a group's contacts in the equations of motion.
class EventTurning {
 public:
  void set(std::span<const EventContact> contacts, std::span<const RigidBody> bodies);
  std::span<const TurningPart> parts() const { return parts_; }

  /// Sets up the unknowns that belong to the contacts `acting`, in their order, whose force points
  /// are `points`.
  void act(std::span<EventContact* const> acting, std::span<const ForcePoint> points);
  std::span<TurningPoint> points() { return points_; }
  /// Stores the torques that were found.
  void take();
  void book(ContactEffects& out) const;

  /// Slow rolling is stiff as slow slip is, and is treated in the same way (slip_foresight()). h is
  /// the step [s]; the bodies are where it begins.
  bool stiff(double h) const;
  void foresee(double h, std::span<const DofBlock> accelerations);
  void forget_foresight();
  bool foresees() const;
  /// Treats rolling explicitly again where the implicit friction would stop it within the foreseen
  /// time. Returns whether there was any; `found` are the forces by point.
  bool end_foresight(bool solved, std::span<const ForcePoint> points, std::span<const Vec3> found);

 private:
  SlipForesight rolling_foresight(const TurningPart& part, double h) const;

  std::span<const EventContact> contacts_;
  std::span<const RigidBody> bodies_;
  std::vector<TurningPart> parts_;
  std::vector<TurningPoint> points_;
  std::vector<size_t> part_of_;  ///< by TurningPoint: index in parts_
};

}  // namespace tumble
