#pragma once
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tumble {

enum class ContactMode : uint8_t { open, sticking, sliding };
std::string_view to_string(ContactMode mode);

/// All that one contact point claims at one moment, for anyone to check: A and B are key.body_a and
/// key.body_b, everything in world axes. The realtime stepper tells means over the last tick, and
/// no accelerations.
struct ContactCertificate {
  ContactKey key;
  uint64_t feature = 0;  ///< ManifoldPoint::feature
  Vec3 x_world = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();        ///< unit, from A to B
  double gap = 0;                     ///< negative is penetration [m]
  double offset = 0;                  ///< depth that is accepted since it was there at first [m]
  double normal_velocity = 0;         ///< rate of the gap [m/s]
  Vec3 slip_velocity = Vec3::Zero();  ///< of B along the plane, less what belts ask for [m/s]
  double normal_acceleration = 0;     ///< second derivative of the gap [m/s2]
  Vec3 slip_acceleration = Vec3::Zero();  ///< of B relative to A along the plane [m/s2]
  Vec3 force = Vec3::Zero();              ///< on B [N]
  double friction = 0;                    ///< coefficient [-]
  ContactMode mode = ContactMode::open;
  /// |tangential force| / (friction * normal force): 1 on the cone, 0 without friction [-].
  double place_in_cone = 0;
  /// Smaller of normal force and normal acceleration (realtime: velocity), each relative to the
  /// greatest of the bodies that touch each other: one of the two should be 0 [-].
  double complementarity = 0;
  double residual = 0;      ///< of the whole problem that gave the force, by its validator [-]
  std::string_view solver;  ///< that answered
};

/// Newton's second law for one body, in world axes: smooth + contact + joint = change, up to
/// `residual`.
struct BodyBalance {
  uint32_t body = 0;                   ///< slot
  Vec3 smooth_force = Vec3::Zero();    ///< gravity, springs, drag, fields [N]
  Vec3 contact_force = Vec3::Zero();   ///< [N]
  Vec3 joint_force = Vec3::Zero();     ///< [N]
  Vec3 momentum_rate = Vec3::Zero();   ///< mass times acceleration [N]
  Vec3 smooth_torque = Vec3::Zero();   ///< about the centre of mass [N m]
  Vec3 contact_torque = Vec3::Zero();  ///< [N m]
  Vec3 joint_torque = Vec3::Zero();    ///< [N m]
  Vec3 angular_rate = Vec3::Zero();    ///< of the angular momentum [N m]
  /// |what is left| of forces, and of torques, relative to the sum of the magnitudes of all that
  /// act: of each contact by itself [-].
  double residual = 0;
};

/// Sorted by key and feature; bodies by slot, particles behind them.
struct ContactCertificates {
  std::vector<ContactCertificate> contacts;
  std::vector<BodyBalance> bodies;
  /// What slots with particle_bit name, by the rest of them.
  std::vector<ParticleName> particles;
};

}  // namespace tumble
