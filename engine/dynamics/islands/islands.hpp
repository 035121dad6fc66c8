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
  uint32_t a = 0, b = 0;  ///< of a joint a may be `none`: the world
  uint32_t joint = none;  ///< index of the joint that it stands for
};

/// Awake dynamic bodies that act on each other, as ranges of IslandSet::bodies, ::contacts and
/// ::joints.
struct Island {
  uint32_t body_begin = 0, body_end = 0;
  uint32_t contact_begin = 0, contact_end = 0;
  uint32_t joint_begin = 0, joint_end = 0;
  uint32_t points = 0;    ///< of its contacts
  bool restless = false;  ///< a moving kinematic body touches it: it must not sleep
};

/// The islands of a tick, ordered by their lowest body slot; bodies and contacts ascend within an
/// island, joints are in the order of the links.
struct IslandSet {
  std::vector<Island> islands;
  std::vector<uint32_t> bodies;     ///< body slots
  std::vector<uint32_t> contacts;   ///< indices into the contact set
  std::vector<uint32_t> joints;     ///< BodyLink::joint
  std::vector<uint32_t> island_of;  ///< by body slot: 1 + index of its island, 0 for none
  std::vector<uint32_t> woken;      ///< slots of those that build_islands woke, ascending
  /// Slots, ascending, of all bodies that have to do with the tick: the awake, and what they touch
  /// or are tied to.
  std::vector<uint32_t> involved;

  /// What most loops ask of a contact: contacts are far apart in memory, and the way to them is
  /// long.
  struct Ends {
    uint32_t a, b;  ///< body slots
    uint16_t points;
    bool bounces;          ///< with some restitution
    bool resists_turning;  ///< Contact::resists_turning
  };
  std::vector<Ends> ends;  ///< by index into the contact set

  /// Adds islands of other bodies; their contacts and joints, which have other indices, stay
  /// behind.
  void append(const IslandSet& others);
  void add_memory(MemoryUse& use) const;

 private:
  friend class IslandBuilder;
  DisjointSets sets_;
  std::vector<uint8_t> flag_;
  std::vector<uint8_t> kind_;    ///< by body slot: what matters here
  std::vector<uint8_t> known_;   ///< by body slot: kind_ is of this tick
  std::vector<uint32_t> owner_;  ///< by contact: island_of the body that owns it
};

/// Groups the bodies by contacts between dynamic bodies and by `links`, and wakes every sleeping
/// body that is tied to an awake one: an awake body or a moving kinematic one touches it (or will
/// within the tick of `h` seconds), a spring pulls it, or it belonged to the same pile as a body
/// woken from outside. Contacts of bodies that rest are brought back as far as these wake. On the
/// threads of the crew, if there is one; with a roster only what has to do with its active bodies
/// is touched.
void build_islands(std::span<RigidBody> bodies, ContactSet& contacts,
                   std::span<const BodyLink> links, double h, IslandSet& out, Crew* crew = nullptr,
                   const Roster* roster = nullptr);

}  // namespace tumble
