#pragma once
#include "engine/dynamics/event/body_group.hpp"

namespace tumble {

/// A group at one moment of its tick, shared by all that moves it: bodies, contacts with their
/// mode, and the equations of motion in that mode.
struct GroupState {
  std::span<RigidBody> bodies;
  BodyGroup& group;
  /// By slot, the body's place in the group; no_block for fixed bodies.
  std::span<const uint32_t> block_of;
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
  /// The joints' equations at the bodies' present poses.
  const Articulation& joints_now();
  ImpactPoint impact_point(const EventContact& contact, const ElementGap& gap) const;
  void find_contacts(bool accept_overlap);
  std::span<EventContact> contacts_of(const EventPair& pair) const {
    return std::span(contacts).subspan(pair.first_contact, pair.contacts);
  }
  /// Deepest overlap of any contact beyond the greatest accepted depth of its pair [m]: as
  /// overlapping shapes slide, the deepest point moves from one contact to another.
  double deepest() const;
  Error error(std::string what, std::string cure) const;
  /// The same, but names the bodies that are crushed where that is the cause; considers contacts
  /// that close within a tick.
  Error lost(std::string what, std::string cure);
};

}  // namespace tumble
