#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/event/event_drives.hpp"
#include "engine/dynamics/joints/articulation.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// What one cause does to bodies, per second or over a time.
struct CauseEffect {
  static constexpr size_t numbers = 8;
  double work = 0;                       ///< given to the motion [J]
  double lost = 0;                       ///< of that, what no potential pays for [J]
  Vec3 momentum = Vec3::Zero();          ///< [kg m/s]
  Vec3 angular_momentum = Vec3::Zero();  ///< about the origin [kg m2/s]

  void add(const CauseEffect& e) {
    work += e.work;
    lost += e.lost;
    momentum += e.momentum;
    angular_momentum += e.angular_momentum;
  }
  void write(std::span<double> y) const;
  static CauseEffect read(std::span<const double> y);
};

/// The smooth forces one by one, for books of who did what.
class ForceRates {
 public:
  virtual ~ForceRates() = default;
  /// Numbers of the causes that act on any of these bodies.
  virtual std::vector<uint32_t> causes(std::span<const uint32_t> bodies) const = 0;
  /// What each of these causes does to the bodies at a time since the beginning of the tick, per
  /// second. Leaves the force sums of the bodies anywhere.
  virtual void rates(double t, std::span<const uint32_t> bodies, std::span<const uint32_t> causes,
                     std::span<CauseEffect> out) const = 0;
};

/// Who does what at contacts and joints, and what corrections do: of drift, and of overlap that was
/// there before. `normal` and `friction` are also those of hard limits and of friction of joints.
enum class ContactCause : uint8_t {
  normal,
  friction,
  kinematic,
  joints,
  motors,
  projection,
  offset
};
constexpr size_t contact_causes = 7;
/// The first of them act all the time, and are integrated.
constexpr size_t integrated_causes = 5;
using ContactEffects = std::array<CauseEffect, contact_causes>;

/// What a joint did over a time, but for smooth forces along its coordinates [N s] or [N m s].
struct JointImpulses {
  std::array<double, JointRows::most> rows{};     ///< of its parts, then along its coordinates
  std::array<double, most_coordinates> motors{};  ///< of these the share of motors
  /// By how much angles changed meanwhile, full turns counted step by step [rad].
  std::array<double, most_coordinates> turned{};

  void add(const JointImpulses& more);
};

/// To whom it is booked what a part does: hard limits to `normal`.
ContactCause cause_of(const DrivePart& part);

/// What happened to the bodies of a group in a tick, by cause.
struct GroupBooks {
  std::vector<uint32_t> causes;     ///< ascending
  std::vector<CauseEffect> forces;  ///< of the causes
  ContactEffects contacts;
  std::vector<JointImpulses> joints;  ///< by joint of the group
  std::vector<double> couplings;      ///< by coupling of the group [N s] or [N m s]

  /// Adds what happened to others of the group, by cause; not the impulses of joints.
  void add_causes(const GroupBooks& part);
  /// Adds impulses by row.
  void add_impulses(const Articulation& held, std::span<const double> impulses);
  /// Likewise by part.
  void add_impulses(const EventDrives& drives, std::span<const double> impulses);
};

/// Velocities of a body, or their mean before and after an impulse.
struct BodyVelocity {
  Vec3 v = Vec3::Zero(), omega = Vec3::Zero();
};

/// Adds the effect of a push P (force or impulse) on B and -P on A at a point, with the velocities
/// that the bodies have meanwhile: along the normal, across it against slip relative to the belt,
/// and what bodies that nothing moves and belts do.
void add_push(const RigidBody& a, const BodyVelocity& of_a, const RigidBody& b,
              const BodyVelocity& of_b, const Vec3& x_world, const Vec3& normal, const Vec3& push,
              const Vec3& belt, ContactEffects& out);

/// The same for a torque on B and against A, of rolling and torsional friction.
void add_torque(const RigidBody& a, const RigidBody& b, const Vec3& torque, ContactEffects& out);

/// Bodies of a group and their velocities, or the means of those, by block.
struct MovingBlocks {
  std::vector<const RigidBody*> bodies;
  std::vector<BodyVelocity> velocities;
};

/// The same for a push along a row, by its cause.
void add_row_push(const Row& row, double push, ContactCause cause, const MovingBlocks& blocks,
                  ContactEffects& out);
/// The same for pushes by the rows of joints, and of what couples them. What joints do over the
/// relative motion that they hold is nothing but rounding; what goes into rotors is energy there.
void add_joint_pushes(const Articulation& held, std::span<const double> pushes,
                      const MovingBlocks& blocks, ContactEffects& out);

}  // namespace tumble
