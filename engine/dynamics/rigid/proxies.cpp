#include "engine/dynamics/rigid/proxies.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {

double contact_margin(const RigidBody& body, double margin) {
  // A fixed or kinematic body leaves the choice to its dynamic partner.
  if (!body.dynamic() || !std::isfinite(body.bounding_radius)) return margin;
  return std::min(margin, 0.1 * body.bounding_radius);
}

double foresight(const RigidBody& body) {
  return std::max(body.inner_radius, 0.1 * body.bounding_radius);
}

bool seeks_contacts(const RigidBody& body) {
  if (!body.awake()) return false;
  return body.dynamic() || !body.v.isZero(0) || !body.omega.isZero(0);
}

void update_proxies(std::span<const RigidBody> bodies, const Vec3& gravity, double h, double margin,
                    ProxySet& out) {
  out.proxies.clear();
  out.refs.clear();
  for (uint32_t i = 0; i < bodies.size(); ++i) {
    const RigidBody& body = bodies[i];
    const bool moving = seeks_contacts(body);
    Vec3 step = Vec3::Zero();
    if (moving) {
      step = h * body.v;
      if (body.dynamic()) {
        step += h * h * (body.gravity_scale * gravity + body.inverse_mass * body.force);
      }
    }
    const double turn = moving ? body.omega.norm() * h : 0;
    const double wide = contact_margin(body, margin);
    for (uint32_t s = 0; s < body.shapes.size(); ++s) {
      const Aabb now = body.shapes[s].shape->bounds(body.pose * body.shapes[s].pose);
      Aabb bounds = now;
      bounds.min += step.cwiseMin(Vec3::Zero());
      bounds.max += step.cwiseMax(Vec3::Zero());
      // No point moves farther by turning than twice its distance from the centre.
      const double reach = turn > 0 ? std::min(turn, 2.0) * body.bounding_radius : 0;
      out.proxies.push_back({bounds.inflated(wide + reach), moving});
      out.refs.push_back({i, s});
    }
  }
}

}  // namespace tumble
