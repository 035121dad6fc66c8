#include "viewer/interact/picking.hpp"

#include <cmath>

namespace tumble {

std::optional<uint32_t> find_slot(const Frame& frame, BodyId id) {
  if (id.is_null() || id.index >= frame.body_slots()) return std::nullopt;
  if (frame.body(id.index).id != id) return std::nullopt;
  return id.index;
}

std::optional<Pick> pick(const Frame& from, const Frame& to, double s, const Ray& ray,
                         double max_distance) {
  std::optional<Pick> best;
  double nearest = max_distance;
  for (size_t slot = 0; slot < to.body_slots(); ++slot) {
    const BodyFrame& body = to.body(slot);
    if (body.id.is_null()) continue;
    const BodyInfo& info = to.info(slot);
    if (!info.look.visible) continue;
    const Pose centre = interpolated_pose(from, to, slot, s);
    for (size_t k = 0; k < info.shapes.size(); ++k) {
      const BodyShape& part = info.shapes[k];
      const Pose pose = centre * part.pose;
      const Vec3 origin = pose.inverse_point(ray.origin);
      const Vec3 direction = pose.inverse_direction(ray.direction);
      const double radius = part.shape->bounding_radius();
      if (std::isfinite(radius) && origin.cross(direction).norm() > radius) continue;
      const std::optional<RayHit> hit = part.shape->ray_cast(origin, direction, nearest);
      // A body around the eye is not what the pointer is on.
      if (!hit || hit->t >= nearest || !(hit->t > 0)) continue;
      nearest = hit->t;
      const Vec3 x = ray.origin + hit->t * ray.direction;
      best = Pick{.body = body.id,
                  .slot = uint32_t(slot),
                  .shape = uint32_t(k),
                  .distance = hit->t,
                  .x_world = x,
                  .normal = pose.direction(hit->normal),
                  .point_body = centre.inverse_point(x) + info.centre_body,
                  .type = info.type};
    }
  }
  return best;
}

Aabb body_bounds(const Frame& frame, uint32_t slot) {
  Aabb bounds;
  for (const BodyShape& part : frame.info(slot).shapes) {
    const Aabb b = part.shape->bounds(frame.body(slot).pose * part.pose);
    if (b.min.allFinite() && b.max.allFinite()) bounds.include(b);
  }
  return bounds;
}

}  // namespace tumble
