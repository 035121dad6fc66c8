#pragma once
#include "engine/dynamics/event/event_contact.hpp"

namespace tumble {

struct SlipForesight {
  double time = 0;     ///< [s]
  double braking = 0;  ///< at most, of the slip by this contact's friction [m/s2]
};

/// Friction against slow slip is stiff: the slip turns towards its own acceleration at the rate
/// r = mu f_n w / |slip|, where w is the compliance of the contact along its plane, and explicit
/// integrators blow up where r h > 2. There friction opposes the slip as it will be after `time`,
/// slip + time * acceleration, which makes the rate r / (1 + r time) <= 1 / h. Zero while r h <
/// 1/2: what converges with the step keeps its order, and where slip does not turn nothing changes.
/// `h`: the step [s]; r is `braking` over `speed`, or that of a contact. The bodies are where the
/// step begins.
SlipForesight slip_foresight(double braking, double speed, double h);
SlipForesight slip_foresight(const EventContact& contact, std::span<const RigidBody> bodies,
                             double h);

/// The force of a contact [N]. One that is new has none yet: that it carries a whole body is more
/// than enough.
double load_of(const EventContact& contact, std::span<const RigidBody> bodies);

}  // namespace tumble
