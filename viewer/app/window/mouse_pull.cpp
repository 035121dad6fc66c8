#include "viewer/app/window/mouse_pull.hpp"

#include "engine/world/world.hpp"

#include <algorithm>

namespace tumble {

void MousePull::take(Session& session, const MouseSpringDef& spring) {
  holds_ = true;
  session.post([springs = springs_, spring](World& world) {
    const auto id = world.create_force(spring);
    if (!id) return;
    springs->held = *id;
    // After going back in time the same ids are given again.
    if (std::find(springs->made.begin(), springs->made.end(), *id) == springs->made.end())
      springs->made.push_back(*id);
  });
}

void MousePull::move(Session& session, const MouseSpringDef& spring) {
  if (!holds_) return;
  session.post([springs = springs_, spring](World& world) {
    if (springs->held) (void)world.set_force(springs->held, spring);
  });
}

void MousePull::turn(Session& session, BodyId id, const Vec3& omega) {
  if (!holds_) return;
  session.post([id, omega](World& world) {
    if (const RigidBody* body = world.body(id)) (void)world.set_velocity(id, body->v, omega);
  });
}

void MousePull::let_go(Session& session) {
  if (!holds_) return;
  holds_ = false;
  session.post([springs = springs_](World& world) {
    if (springs->held) (void)world.destroy_force(springs->held);
    springs->held = {};
  });
}

void MousePull::let_go_of_the_past(Session& session) {
  let_go(session);
  session.post([springs = springs_](World& world) {
    for (const ForceId id : springs->made) (void)world.destroy_force(id);  // it may no longer exist
  });
}

}  // namespace tumble
