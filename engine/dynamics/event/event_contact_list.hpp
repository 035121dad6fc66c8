#pragma once
#include "engine/dynamics/event/event_contact.hpp"

namespace tumble {

/// The contacts of the event stepper that touch or have pressed during the tick, in the form in
/// which the realtime stepper keeps its own, sorted by key: for frames and queries, and for the
/// start of its solver after a change of stepper.
std::vector<Contact> contact_list(std::span<const EventContact> contacts,
                                  std::span<const RigidBody> bodies);

}  // namespace tumble
