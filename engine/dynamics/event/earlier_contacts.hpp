#pragma once
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_pair.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace tumble {

/// Pointers to the contacts, sorted by their bodies and shapes.
std::vector<const EventContact*> by_shapes(std::span<const EventContact> contacts);

/// Finds which earlier contact a new one continues: one at the same place now, or else one of the
/// same features.
class Continued {
 public:
  /// `before` as by_shapes() returns it.
  Continued(std::span<const RigidBody> bodies, std::span<const EventContact* const> before,
            const ContactKey& pair);
  /// The earlier contact within `near` [m] of where the contact is, or with its features; each is
  /// returned only once.
  const EventContact* of(const EventContact& c, const Vec3& x_world, double near);
  bool none() const { return known_.empty(); }
  double offset() const {
    double most = 0;
    for (const Known& k : known_) most = std::max(most, k.contact->offset);
    return most;
  }
  /// Calls visit(contact, its present place) for each earlier contact that no new one continues.
  template <class Visit>
  void for_each_left(const Visit& visit) const {
    for (const Known& k : known_)
      if (!k.taken && k.now.regular) visit(*k.contact, k.now);
  }

 private:
  struct Known {
    const EventContact* contact;
    ElementPlace now;
    bool taken = false;
  };
  std::vector<Known> known_;
};

/// Adds to the contacts of a pair, which begin at `first`, earlier ones that still nearly touch at
/// the same features. A manifold holds only four points, and on a nearly flat surface other four
/// every time; so points stay watched.
void keep_near(const Continued& continued, std::span<const RigidBody> bodies, const EventPair& pair,
               size_t first, std::vector<EventContact>& out);

}  // namespace tumble
