#include "engine/dynamics/forces/mouse_spring.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tumble {

// The point behaves as a mass M = K^-1 (K its mobility) on a spring M w^2 with damping 2 z w M,
// taken implicitly over the tick: v+ = v - h (w^2 (x + h v+ - target) + 2 z w v+), F = M (v+ - v) /
// h.
void apply(const MouseSpringDef& def, ForceContext& context) {
  const auto at = locate(def.anchor, context);
  if (!at) return;
  const Mat3 K = mobility(def.anchor, context);
  if (!(K.trace() > 0)) return;
  const double h = context.h;
  const double frequency = std::min(def.frequency, 0.4 / h);
  const double w = 2 * det::pi * frequency, c = 2 * def.damping_ratio * w;
  const Vec3 a = -(w * w * (at->x_world - def.target) + (c + h * w * w) * at->v_world) /
                 (1 + h * c + h * h * w * w);
  Vec3 force = K.inverse() * a;
  double mass = 1 / (K.trace() / 3);
  RigidBody* body =
      def.anchor.kind == Anchor::Kind::body ? context.bodies.find(def.anchor.body) : nullptr;
  if (body) mass = body->mass;
  const double cap = def.max_weights * mass * (context.gravity > 0 ? context.gravity : 9.81);
  const double size = force.norm();
  if (size > cap) force *= cap / size;
  add_force(def.anchor, force, context);
  if (body && body->dynamic()) {
    const double rate = 0.5 * def.damping_ratio * w;
    body->torque -= rate / (1 + h * rate) * (body->inertia_world() * body->omega);
  }
}

}  // namespace tumble
