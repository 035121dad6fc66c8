#pragma once
#include "engine/core/result.hpp"
#include "engine/dynamics/contact/contact_certificate.hpp"
#include "engine/dynamics/event/event_system.hpp"
#include "engine/dynamics/islands/islands.hpp"

namespace tumble {

/// What the contacts of the event stepper claim at the bodies' present poses and velocities: the
/// forces are solved for afresh, and of all that give this motion the least are told. Bodies that
/// touch each other, or that one of the joints named by links holds together, are one problem.
/// Bodies are given back as they were. `forces` may set what acts on any body, `courses` how
/// kinematic ones go on. Error: no forces were found.
Result<ContactCertificates> certify(std::span<RigidBody> bodies,
                                    std::span<const EventContact> contacts,
                                    const SmoothForces& forces, ContactForceMethod method,
                                    const JointsAndCouplings& joints = {},
                                    std::span<const BodyLink> links = {},
                                    std::span<const CourseMotion> courses = {});

/// The problem of contact forces of the bodies that touch, or are jointed with, one of them.
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

/// The problem that certify() solves for the bodies around one, with its answer if there is one;
/// nothing in it where that body touches nothing that moves or presses it. Bodies are given back
/// as they were.
Result<GroupForceProblem> pose_contact_forces(std::span<RigidBody> bodies, uint32_t slot,
                                              std::span<const EventContact> contacts,
                                              const SmoothForces& forces, ContactForceMethod method,
                                              const JointsAndCouplings& joints = {},
                                              std::span<const BodyLink> links = {},
                                              std::span<const CourseMotion> courses = {});

}  // namespace tumble
