#include "engine/dynamics/realtime/tick_parts.hpp"

#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/dynamics/realtime/tolerances.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// How thin a moving mesh is [m]; infinite for every other shape. A sharp rim does not count as
/// thin: `thin_of_size` is the least.
double thickness(const RigidBody& body, uint32_t shape) {
  const Shape& s = *body.shapes[shape].shape;
  if (!body.dynamic() || !s.is_mesh()) return std::numeric_limits<double>::infinity();
  const MeshSurface& surface = s.polyhedral()->surface();
  return std::max(surface.min_thickness, tolerances::thin_of_size * surface.size);
}

/// Bound on how fast any two points of the bodies pass each other [m/s].
double passing_speed(const RigidBody& a, const RigidBody& b) {
  double speed = (a.v - b.v).norm();
  for (const RigidBody* body : {&a, &b})
    if (!body->omega.isZero(0)) speed += body->omega.norm() * body->bounding_radius;
  return speed;
}

}  // namespace

int tick_parts(std::span<const RigidBody> bodies, const ProxySet& proxies,
               std::span<const ProxyPair> pairs, double h, const RealtimeSettings& settings) {
  if (!proxies.moving_meshes) return 1;
  double most = 1;
  for (const ProxyPair& pair : pairs) {
    const ShapeRef &ra = proxies.refs[pair.a], &rb = proxies.refs[pair.b];
    const RigidBody &a = bodies[ra.body], &b = bodies[rb.body];
    const double thin = std::min(thickness(a, ra.shape), thickness(b, rb.shape));
    if (!std::isfinite(thin)) continue;
    most = std::max(most,
                    std::ceil(passing_speed(a, b) * h / (tolerances::passed_of_thickness * thin)));
  }
  return int(std::min(most, double(settings.max_parts)));
}

RealtimeSettings part_settings(const RealtimeSettings& settings, int parts) {
  RealtimeSettings part = settings;
  part.substeps = (settings.substeps + parts - 1) / parts;
  part.max_substeps = (settings.max_substeps + parts - 1) / parts;
  return part;
}

}  // namespace tumble
