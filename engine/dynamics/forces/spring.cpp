#include "engine/dynamics/forces/spring.hpp"

#include "engine/dynamics/forces/anchor.hpp"
#include "engine/dynamics/forces/spring_pulls.hpp"

namespace tumble {

void apply(const SpringDef& def, ForceContext& context) {
  if (!context.momentary) {
    const SpringDef* alone = &def;
    NetPulls pulls;
    pull_springs({{&alone, 1}, {}}, context, {}, pulls);
    return add_pull(def, pulls.springs[0], context);
  }
  const auto a = locate(def.a, context), b = locate(def.b, context);
  if (!a || !b) return;
  const Vec3 d = b->x_world - a->x_world;
  const double length = d.norm();
  if (!(length > 0)) return;  // the direction is undefined; the force acts again once it is not
  const Vec3 n = d / length;
  const double tension =
      def.stiffness * (length - def.rest_length) + def.damping * n.dot(b->v_world - a->v_world);
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
