#pragma once
#include "engine/dynamics/event/event_contact.hpp"
#include "engine/dynamics/event/event_pair.hpp"

#include <algorithm>
#include <span>
#include <vector>

namespace tumble {

/// In the order of their shapes.
std::vector<const EventContact*> by_shapes(std::span<const EventContact> contacts);

/// Finds what a contact continues: what is at its place now, or else the same features.
class Continued {
 public:
  /// `before` in the order of their shapes.
  Continued(std::span<const RigidBody> bodies, std::span<const EventContact* const> before,
            const ContactKey& pair);
  /// The one within `near` [m] of where the contact is, or with its features; each is taken once.
  const EventContact* of(const EventContact& c, const Vec3& x_world, double near);
  bool none() const { return known_.empty(); }
  double offset() const {
    double most = 0;
    for (const Known& k : known_) most = std::max(most, k.contact->offset);
    return most;
  }
  /// Calls with each contact that nothing continues, and its gap.
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

/// A manifold holds no more than four points, and of a surface that is nearly flat other four every
/// time: points that nearly touch stay watched as long as they are what they were. They are added
/// to those of the pair, which begin at `first`.
void keep_near(const Continued& continued, std::span<const RigidBody> bodies, const EventPair& pair,
               size_t first, std::vector<EventContact>& out);

}  // namespace tumble
