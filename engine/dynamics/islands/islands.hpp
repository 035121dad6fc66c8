#pragma once
#include "engine/core/crew.hpp"
#include "engine/core/disjoint_sets.hpp"
#include "engine/dynamics/bodies/body.hpp"
#include "engine/dynamics/bodies/roster.hpp"
#include "engine/dynamics/contact/contact_set.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace tumble {

/// Two bodies that something other than a contact ties together (springs, joints), by slot.
struct BodyLink {
  static constexpr uint32_t none = ~uint32_t{0};
  uint32_t a = 0, b = 0;  ///< slots; of a joint with the world, a is `none`
  uint32_t joint = none;  ///< index of the joint, if the link is one
};

/// Awake dynamic bodies that act on each other, as ranges in IslandSet::bodies, ::contacts and
/// ::joints.
struct Island {
  uint32_t body_begin = 0, body_end = 0;
  uint32_t contact_begin = 0, contact_end = 0;
  uint32_t joint_begin = 0, joint_end = 0;
  uint32_t points = 0;    ///< number of points of its contacts
  bool restless = false;  ///< a moving kinematic body touches or pulls it: it must not sleep
};

/// The islands of a tick, ordered by their lowest body slot. Within an island, bodies and contacts
/// are ascending and joints in the order of the links.
struct IslandSet {
  std::vector<Island> islands;
  std::vector<uint32_t> bodies;     ///< body slots
  std::vector<uint32_t> contacts;   ///< indices into the contact set
  std::vector<uint32_t> joints;     ///< BodyLink::joint
  std::vector<uint32_t> island_of;  ///< by body slot: 1 + index of its island, 0 for none
  std::vector<uint32_t> woken;      ///< slots of bodies that build_islands woke, ascending
  /// Slots, ascending, of all bodies that take part in the tick: the active ones, and those that
  /// they touch or are tied to.
  std::vector<uint32_t> involved;

  /// What most loops need of a contact, stored compactly: contacts are large, and access to them is
  /// slow.
  struct Ends {
    uint32_t a, b;  ///< slots of bodies
    uint16_t points;
    bool bounces;          ///< has restitution
    bool resists_turning;  ///< Contact::resists_turning
  };
  std::vector<Ends> ends;  ///< by index into the contact set

  /// Adds islands of other bodies; not their contacts and joints, whose indices differ.
  void append(const IslandSet& others);
  void add_memory(MemoryUse& use) const;

 private:
  friend class IslandBuilder;
  DisjointSets sets_;
  std::vector<uint8_t> flag_;
  std::vector<uint8_t> kind_;    ///< by body slot: properties of the body that matter here
  std::vector<uint8_t> known_;   ///< by body slot: kind_ is up to date
  std::vector<uint32_t> owner_;  ///< by contact: island_of the body that owns it
};

/// Groups the bodies by contacts between dynamic bodies and by `links`. Wakes every sleeping body
/// that must wake: one that an awake body or a moving kinematic body touches (or will within the
/// tick of `h` seconds), one that a link connects with an awake body, or one of the same pile as a
/// body that was woken from outside. Contacts of resting bodies are brought back as far as these
/// wake. Runs on the threads of the crew, if there is one; with a roster, visits only bodies that
/// its active bodies involve.
void build_islands(std::span<RigidBody> bodies, ContactSet& contacts,
                   std::span<const BodyLink> links, double h, IslandSet& out, Crew* crew = nullptr,
                   const Roster* roster = nullptr);

}  // namespace tumble
