#pragma once
#include "engine/dynamics/event/event_contact.hpp"

namespace tumble {

/// The contacts of the event stepper that touch, or pressed during the tick, in the form of the
/// realtime stepper, sorted by key: for frames and queries, and as a warm start after a change of
/// stepper.
std::vector<Contact> contact_list(std::span<const EventContact> contacts,
                                  std::span<const RigidBody> bodies);

}  // namespace tumble
