#pragma once
#include "engine/dynamics/contact/contact.hpp"
#include "engine/dynamics/particles/particle_system.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace tumble {

enum class ContactMode : uint8_t { open, sticking, sliding };
std::string_view to_string(ContactMode mode);

/// What one contact point claims at one moment, so that anyone can check the contact conditions. A
/// and B are key.body_a and key.body_b; all vectors are in world axes. The realtime stepper reports
/// means over the last tick, and no accelerations.
struct ContactCertificate {
  ContactKey key;
  uint64_t feature = 0;  ///< ManifoldPoint::feature
  Vec3 x_world = Vec3::Zero();
  Vec3 normal = Vec3::UnitY();  ///< unit, from A to B
  double gap = 0;               ///< negative is penetration [m]
  double offset = 0;            ///< accepted depth: overlap that existed when the contact began [m]
  double normal_velocity = 0;   ///< rate of the gap [m/s]
  /// Velocity of B relative to A in the tangent plane, less that of belts [m/s]
  Vec3 slip_velocity = Vec3::Zero();
  double normal_acceleration = 0;         ///< second derivative of the gap [m/s2]
  Vec3 slip_acceleration = Vec3::Zero();  ///< of B relative to A in the tangent plane [m/s2]
  Vec3 force = Vec3::Zero();              ///< on B [N]
  double friction = 0;                    ///< coefficient [-]
  ContactMode mode = ContactMode::open;
  /// |tangential force| / (friction * normal force): 1 on the cone, 0 without friction [-].
  double place_in_cone = 0;
  /// The smaller of normal force and normal acceleration (realtime: normal velocity), each divided
  /// by the greatest one among the bodies of the same problem: 0 if the two are complementary [-].
  double complementarity = 0;
  /// Residual of the whole problem that gave the force, by the validator of its solver [-]
  double residual = 0;
  std::string_view solver;  ///< name of the solver that found the force
};

/// Newton's second law for one body, in world axes: smooth + contact + joint = rate of change, up
/// to `residual`.
struct BodyBalance {
  uint32_t body = 0;                   ///< slot
  Vec3 smooth_force = Vec3::Zero();    ///< gravity, springs, drag, fields [N]
  Vec3 contact_force = Vec3::Zero();   ///< [N]
  Vec3 joint_force = Vec3::Zero();     ///< [N]
  Vec3 momentum_rate = Vec3::Zero();   ///< mass times acceleration [N]
  Vec3 smooth_torque = Vec3::Zero();   ///< about the centre of mass [N m]
  Vec3 contact_torque = Vec3::Zero();  ///< [N m]
  Vec3 joint_torque = Vec3::Zero();    ///< [N m]
  Vec3 angular_rate = Vec3::Zero();    ///< rate of change of the angular momentum [N m]
  /// Magnitude of the imbalance of forces, or of torques, divided by the sum of the magnitudes of
  /// all that act, every contact counted by itself; the greater of the two [-].
  double residual = 0;
};

/// Contacts by key and feature; bodies by slot, followed by particles.
struct ContactCertificates {
  std::vector<ContactCertificate> contacts;
  std::vector<BodyBalance> bodies;
  /// The particles that slots with particle_bit stand for, indexed by the slot without that bit.
  std::vector<ParticleName> particles;
};

}  // namespace tumble
