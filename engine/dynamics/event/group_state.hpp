#pragma once
#include "engine/dynamics/event/body_group.hpp"

namespace tumble {

/// A group at one moment of its tick, as all that moves it sees it: bodies, contacts with the mode
/// that they are in, and the equations of motion that go with these.
struct GroupState {
  std::span<RigidBody> bodies;
  BodyGroup& group;
  std::span<const uint32_t> block_of;  ///< by slot the body's place, no_block for fixed bodies
  const EventContext& context;
  EventSystem system;
  std::vector<EventPair>& pairs;
  std::vector<EventContact>& contacts;
  TickPart part;
  double now = 0;  ///< since the beginning of the tick [s]

  GroupState(std::span<RigidBody> all_bodies, BodyGroup& of, std::span<const uint32_t> places,
             const SmoothForces& forces, const EventContext& given);
  std::vector<DofBlock> blocks() const { return blocks_of(bodies, group.bodies); }
  void set_velocities(std::span<const DofBlock> blocks);
  /// The joints at the bodies' present poses.
  const Articulation& joints_now();
  ImpactPoint impact_point(const EventContact& contact, const ElementGap& gap) const;
  void find_contacts(bool accept_overlap);
  std::span<EventContact> contacts_of(const EventPair& pair) const {
    return std::span(contacts).subspan(pair.first_contact, pair.contacts);
  }
  /// How far any contact is in beyond what its pair was accepted with [m]: where two overlap, other
  /// points of theirs are the deepest ones as they slide.
  double deepest() const;
  Error error(std::string what, std::string cure) const;
  /// The same where that is the cause: what is crushed in the contacts that close in this tick.
  Error lost(std::string what, std::string cure);
};

}  // namespace tumble
