#pragma once
#include "engine/dynamics/event/event_contact.hpp"

namespace tumble {

struct SlipForesight {
  double time = 0;     ///< how far ahead the slip is extrapolated [s]
  double braking = 0;  ///< greatest deceleration of the slip by this contact's friction [m/s2]
};

/// Friction against slow slip is stiff: the slip relaxes towards its steady value at the rate r =
/// mu f_n w / |slip|, where w is the compliance of the contact in its tangent plane, and explicit
/// integrators are unstable where r h > 2. There friction opposes the slip as it will be after
/// `time`, slip + time * acceleration (linearly implicit), which lowers the rate to r / (1 + r
/// time) <= 1 / h. `time` is zero while r h < 1/2, so that the order of convergence is kept, and it
/// changes nothing where slip keeps its direction. `h`: the step [s]; r is `braking` / `speed`, or
/// that of a contact. The bodies are where the step begins.
SlipForesight slip_foresight(double braking, double speed, double h);
SlipForesight slip_foresight(const EventContact& contact, std::span<const RigidBody> bodies,
                             double h);

/// The magnitude of the force of a contact [N]. A new contact has none yet, and is assumed to carry
/// the greater of the forces on its two bodies.
double load_of(const EventContact& contact, std::span<const RigidBody> bodies);

}  // namespace tumble
