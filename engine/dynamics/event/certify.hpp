#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/contact/contact_certificate.hpp"
#include "engine/dynamics/event/event_system.hpp"
#include "engine/dynamics/islands/islands.hpp"

namespace tumble {

/// What the contacts of the event stepper claim at the bodies' present poses and velocities. The
/// forces are solved for anew, and where several sets of forces give the same motion the least is
/// reported. Bodies that touch each other, or are connected by joints that BodyLinks name, form one
/// problem. Restores the bodies. `forces` may set the force on any body; `courses` says how the
/// velocities of kinematic bodies change. Error: no forces were found.
Result<ContactCertificates> certify(std::span<RigidBody> bodies,
                                    std::span<const EventContact> contacts,
                                    const SmoothForces& forces, ContactForceMethod method,
                                    const JointsAndCouplings& joints = {},
                                    std::span<const BodyLink> links = {},
                                    std::span<const CourseMotion> courses = {});

/// The problem of contact forces of the bodies connected to one body by contacts and joints.
struct GroupForceProblem {
  struct Place {
    ContactKey key;
    Vec3 x_world, normal;  ///< unit, from A to B
    bool sliding = false;
  };
  ContactForceProblem problem;
  std::vector<Place> places;     ///< by point of the problem
  std::vector<uint32_t> bodies;  ///< slots, ascending
};

/// The problem that certify() solves for the bodies around one body, with its solution if there is
/// one; empty where that body has no contacts with force. Restores the bodies.
Result<GroupForceProblem> pose_contact_forces(std::span<RigidBody> bodies, uint32_t slot,
                                              std::span<const EventContact> contacts,
                                              const SmoothForces& forces, ContactForceMethod method,
                                              const JointsAndCouplings& joints = {},
                                              std::span<const BodyLink> links = {},
                                              std::span<const CourseMotion> courses = {});

}  // namespace tumble
