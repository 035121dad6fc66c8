#include "engine/dynamics/islands/waking.hpp"

namespace tumble {

void wake(RigidBody& body) {
  body.asleep = false;
  body.rest.time = 0;
}

void wake_touching(std::span<RigidBody> bodies, const ContactSet& contacts, uint32_t body) {
  contacts.for_each([&](const Contact& c) {
    if (c.key.body_a == body) wake(bodies[c.key.body_b]);
    if (c.key.body_b == body) wake(bodies[c.key.body_a]);
  });
}

void wake_all(std::span<RigidBody> bodies) {
  for (RigidBody& body : bodies) wake(body);
}

}  // namespace tumble
