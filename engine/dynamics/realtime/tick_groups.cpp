#include "engine/dynamics/realtime/tick_groups.hpp"

namespace tumble {

void HeldBodies::hold(uint32_t slot) {
  RigidBody& body = bodies_[slot];
  held_.push_back({slot, body.type, body.v, body.omega});
  body.type = BodyType::fixed;
  body.v.setZero();
  body.omega.setZero();
}

void HeldBodies::hold_others(const TickParts& parts, int number) {
  for (uint32_t i = 0; i < bodies_.size(); ++i) {
    const int own = parts.of(i);
    if (own != 0 && own != number && bodies_[i].dynamic()) hold(i);
  }
}

HeldBodies::~HeldBodies() {
  for (const Held& held : held_) {
    RigidBody& body = bodies_[held.slot];
    body.type = held.type;
    body.v = held.v;
    body.omega = held.omega;
  }
}

KinematicPaths::KinematicPaths(std::span<RigidBody> bodies, std::span<const uint32_t> active)
    : bodies_(bodies) {
  for (const uint32_t i : active)
    if (!bodies[i].dynamic()) paths_.push_back({i, bodies[i].pose, bodies[i].pose});
}

void KinematicPaths::start() {
  for (const Path& path : paths_) bodies_[path.slot].pose = path.start;
}

void KinematicPaths::keep(const TickParts& parts, int number) {
  for (Path& path : paths_)
    if (parts.of(path.slot) == number) path.end = bodies_[path.slot].pose;
}

void KinematicPaths::finish() {
  for (const Path& path : paths_) bodies_[path.slot].pose = path.end;
}

}  // namespace tumble
