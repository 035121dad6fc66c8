#pragma once
#include "engine/dynamics/contact/contact_set.hpp"

#include <cstdint>
#include <span>

namespace tumble {

/// Wakes a body; build_islands then wakes the bodies that it touches.
void wake(RigidBody& body);

/// Wakes all bodies that touch `body`: to be called before it is removed, teleported, or its
/// velocity is set.
void wake_touching(std::span<RigidBody> bodies, const ContactSet& contacts, uint32_t body);

/// Wakes every body (gravity or another global setting changed).
void wake_all(std::span<RigidBody> bodies);

}  // namespace tumble
