#include "engine/dynamics/forces/spring.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {

void apply(const SpringDef& def, ForceContext& context) {
  const auto a = locate(def.a, context), b = locate(def.b, context);
  if (!a || !b) return;
  const Vec3 d = (b->x_world + lead_of(def.b, context) * b->v_world) -
                 (a->x_world + lead_of(def.a, context) * a->v_world);
  const double length = d.norm();
  if (!(length > 0)) return;  // the direction is undefined; the force acts again once it is not
  const Vec3 n = d / length;
  const double rate = n.dot(b->v_world - a->v_world);
  if (context.momentary) {
    const double tension = def.stiffness * (length - def.rest_length) + def.damping * rate;
    add_force(def.a, tension * n, context);
    add_force(def.b, -tension * n, context);
    return;
  }
  const double mobility_n = n.dot((mobility(def.a, context) + mobility(def.b, context)) * n);
  if (!(mobility_n > 0)) return;
  const double h = context.h;
  double damping = def.damping;
  const double bound = 2 * det::pi * 0.4 / h;
  if (def.stiffness * mobility_n > bound * bound) damping += h * def.stiffness;
  const double tension = (def.stiffness * (length - def.rest_length) + damping * rate) /
                         (1 + h * damping * mobility_n);
  add_force(def.a, tension * n, context);
  add_force(def.b, -tension * n, context);
}

double potential_energy(const SpringDef& def, const ForceContext& context) {
  const auto a = locate(def.a, context), b = locate(def.b, context);
  if (!a || !b) return 0;
  const double stretch = (b->x_world - a->x_world).norm() - def.rest_length;
  return 0.5 * def.stiffness * stretch * stretch;
}

}  // namespace tumble
