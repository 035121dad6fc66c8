#pragma once
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/course_motion.hpp"
#include "engine/dynamics/event/event_drives.hpp"
#include "engine/dynamics/joints/articulation.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// What one cause does to a group of bodies, as a rate or summed over a time.
struct CauseEffect {
  static constexpr size_t numbers = 8;
  double work = 0;               ///< done on the bodies [J]
  double lost = 0;               ///< the part of the work that does not come from a potential [J]
  Vec3 momentum = Vec3::Zero();  ///< [kg m/s]
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

/// The smooth forces separated by cause, for the books of their effects.
class ForceRates {
 public:
  virtual ~ForceRates() = default;
  /// The numbers of all causes that act on any of these bodies.
  virtual std::vector<uint32_t> causes(std::span<const uint32_t> bodies) const = 0;
  /// The effect per second of each of these causes on the bodies, at time t since the beginning of
  /// the tick [s]. Overwrites the force sums of the bodies.
  virtual void rates(double t, std::span<const uint32_t> bodies, std::span<const uint32_t> causes,
                     std::span<CauseEffect> out) const = 0;
};

/// Causes at contacts and joints, and corrections of drift (`projection`) and of accepted overlap
/// (`offset`). `normal` and `friction` include hard limits and dry friction of joints.
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
/// The first of them act continuously and are integrated with the motion.
constexpr size_t integrated_causes = 5;
using ContactEffects = std::array<CauseEffect, contact_causes>;

/// Impulses of a joint over a time, without smooth forces along its coordinates [N s] or [N m s].
struct JointImpulses {
  /// By row: of the joint's parts, then along its coordinates.
  std::array<double, JointRows::most> rows{};
  /// The share of the motors in those along the coordinates.
  std::array<double, most_coordinates> motors{};
  /// Change of each angle meanwhile, with full turns, counted step by step [rad].
  std::array<double, most_coordinates> turned{};

  void add(const JointImpulses& more);
};

/// The cause under which the effects of a drive part are booked: hard limits under `normal`.
ContactCause cause_of(const DrivePart& part);

/// Effects on the bodies of a group in a tick, by cause.
struct GroupBooks {
  std::vector<uint32_t> causes;     ///< ascending
  std::vector<CauseEffect> forces;  ///< effects of these causes
  ContactEffects contacts;
  std::vector<JointImpulses> joints;  ///< by joint of the group
  std::vector<double> couplings;      ///< by coupling of the group [N s] or [N m s]

  /// Adds the effects by cause of another part of the group; not the impulses of joints.
  void add_causes(const GroupBooks& part);
  /// Adds impulses, one for each row of the joints.
  void add_impulses(const Articulation& held, std::span<const double> impulses);
  /// Adds impulses, one for each part of the drives.
  void add_impulses(const EventDrives& drives, std::span<const double> impulses);
};

/// Adds the effects of a force or impulse `push` on B, and its opposite on A, at a point, given the
/// velocities of the bodies meanwhile. The normal part is booked under `normal`, the tangential
/// part under `friction` with its work against slip relative to the belt, and the work of immovable
/// bodies and belts under `kinematic`.
void add_push(const RigidBody& a, const BodyVelocity& of_a, const RigidBody& b,
              const BodyVelocity& of_b, const Vec3& x_world, const Vec3& normal, const Vec3& push,
              const Vec3& belt, ContactEffects& out);

/// The same for a torque on B, and its opposite on A, of rolling and torsional friction.
void add_torque(const RigidBody& a, const RigidBody& b, const Vec3& torque, ContactEffects& out);

/// The bodies of a group and their velocities (or the means of those), by block.
struct MovingBlocks {
  std::vector<const RigidBody*> bodies;
  std::vector<BodyVelocity> velocities;
};

/// The same for a force or impulse along a row, booked under its cause.
void add_row_push(const Row& row, double push, ContactCause cause, const MovingBlocks& blocks,
                  ContactEffects& out);
/// The same for the rows of joints and couplings. Work along relative motion that joints hold at
/// zero is only rounding error; work on rotors is stored in their energy and not lost.
void add_joint_pushes(const Articulation& held, std::span<const double> pushes,
                      const MovingBlocks& blocks, ContactEffects& out);

}  // namespace tumble
