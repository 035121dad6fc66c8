#include "engine/dynamics/forces/load.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/math/rotation.hpp"

namespace tumble {

std::string LoadDef::fault() const {
  if (anchor.kind == Anchor::Kind::body) return {};
  if (anchor.kind == Anchor::Kind::world) return "its anchor must be on a body or a particle";
  if (torque.varies() || !torque.now().isZero(0)) return "only a body can have a torque";
  if (body_axes) return "only a body has axes for body_axes";
  return {};
}

void apply(const LoadDef& def, ForceContext& context) {
  const Vec3 force = def.force.now();
  if (def.anchor.kind != Anchor::Kind::body) return add_force(def.anchor, force, context);
  RigidBody* b = context.bodies.find(def.anchor.body);
  if (!b || !b->dynamic() || b->asleep) return;
  // As the body is turned in the middle of the tick, as far as its velocity tells.
  const Quat q = integrate_rotation(b->pose.q, b->omega, lead_of(def.anchor, context));
  const Vec3 arm = q * Vec3(def.anchor.point - b->centre_body);
  const auto in_world = [&](const Vec3& x) -> Vec3 { return def.body_axes ? Vec3(q * x) : x; };
  const Vec3 push = in_world(force);
  b->force += push;
  b->torque += arm.cross(push) + in_world(def.torque.now());
}

}  // namespace tumble
