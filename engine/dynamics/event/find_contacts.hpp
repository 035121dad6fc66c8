#pragma once
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_pair.hpp"

namespace tumble {

/// The contacts of the pairs at the bodies' present poses; sets the pairs' gaps. A contact that
/// continues one of `before`, by its features or its place, takes over accepted depth, counts and
/// forces. Of a new contact that overlaps, depth is accepted up to the greatest accepted depth of
/// its pair, or all of it if `accept_overlap` and nothing was known of the pair.
std::vector<EventContact> find_event_contacts(std::span<const RigidBody> bodies,
                                              std::span<EventPair> pairs, NarrowPhase narrow_phase,
                                              const HierarchyKind* hierarchy,
                                              std::span<const EventContact> before,
                                              bool accept_overlap);

}  // namespace tumble
