#pragma once
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_pair.hpp"

namespace tumble {

/// The contacts of the pairs at the bodies' present poses, and the pairs' gaps. What continues one
/// of `before`, by its feature or its place, keeps its offset, counts and forces. A contact that
/// is new keeps its depth as offset as far as its pair has one, or all of it when
/// `accept_overlap` and nothing was known of the pair.
std::vector<EventContact> find_event_contacts(std::span<const RigidBody> bodies,
                                              std::span<EventPair> pairs, NarrowPhase narrow_phase,
                                              const HierarchyKind* hierarchy,
                                              std::span<const EventContact> before,
                                              bool accept_overlap);

}  // namespace tumble
