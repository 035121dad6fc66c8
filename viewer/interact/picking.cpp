#include "viewer/interact/picking.hpp"

#include "engine/world/queries/query_scene.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

/// Whether both frames show the same bodies at the same places.
bool same_bodies(const Frame& a, const Frame& b) {
  return &a == &b || (a.chunks == b.chunks && a.infos == b.infos);
}

Pick pick_of(const Frame& frame, const RayQueryHit& hit) {
  const uint32_t slot = hit.target.body.index;
  const BodyInfo& info = frame.info(slot);
  return {.body = hit.target.body,
          .slot = slot,
          .shape = hit.target.shape,
          .distance = hit.distance,
          .x_world = hit.x_world,
          .normal = hit.normal,
          .point_body = frame.body(slot).pose.inverse_point(hit.x_world) + info.centre_body,
          .type = info.type};
}

}  // namespace

std::optional<Pick> Picker::operator()(const std::shared_ptr<const Frame>& from,
                                       const std::shared_ptr<const Frame>& to, double s,
                                       const Ray& ray, double max_distance) {
  const bool still = same_bodies(*from, *to) && seen_ && same_bodies(*seen_, *to);
  seen_ = to;
  if (!still) {
    scene_.reset();
    return pick(*from, *to, s, ray, max_distance);
  }
  if (!scene_) scene_ = std::make_shared<QueryScene>(to);
  const Frame& frame = scene_->frame();
  QueryFilter visible;
  visible.accept = [&](const QueryTarget& t) { return frame.info(t.body.index).look.visible; };
  // A body that contains the eye cannot be picked.
  const auto hit = scene_->ray({.origin = ray.origin,
                                .direction = ray.direction,
                                .max_distance = max_distance,
                                .hit_inside = false},
                               visible);
  if (!hit || !*hit) return std::nullopt;
  return pick_of(frame, **hit);
}

std::optional<uint32_t> find_slot(const Frame& frame, BodyId id) {
  if (id.is_null() || id.index >= frame.body_slots()) return std::nullopt;
  if (frame.body(id.index).id != id) return std::nullopt;
  return id.index;
}

std::optional<Pick> pick(const Frame& from, const Frame& to, double s, const Ray& ray,
                         double max_distance, std::span<const BodyId> ignored) {
  std::optional<Pick> best;
  double nearest = max_distance;
  for (size_t slot = 0; slot < to.body_slots(); ++slot) {
    const BodyFrame& body = to.body(slot);
    if (body.id.is_null()) continue;
    const BodyInfo& info = to.info(slot);
    if (!info.look.visible || std::ranges::find(ignored, body.id) != ignored.end()) continue;
    const Pose centre = interpolated_pose(from, to, slot, s);
    uint32_t next = 0;
    info.for_seen([&](const BodyShape& part, const Vec3f&) {
      const uint32_t k = next++;
      const Pose pose = centre * part.pose;
      const Vec3 origin = pose.inverse_point(ray.origin);
      const Vec3 direction = pose.inverse_direction(ray.direction);
      const double radius = part.shape->bounding_radius();
      if (std::isfinite(radius) && origin.cross(direction).norm() > radius) return;
      const std::optional<RayHit> hit = part.shape->ray_cast(origin, direction, nearest);
      // A body that contains the eye cannot be picked.
      if (!hit || hit->t >= nearest || !(hit->t > 0)) return;
      nearest = hit->t;
      const Vec3 x = ray.origin + hit->t * ray.direction;
      best = Pick{.body = body.id,
                  .slot = uint32_t(slot),
                  .shape = k,
                  .distance = hit->t,
                  .x_world = x,
                  .normal = pose.direction(hit->normal),
                  .point_body = centre.inverse_point(x) + info.centre_body,
                  .type = info.type};
    });
  }
  return best;
}

Aabb body_bounds(const Frame& frame, uint32_t slot) {
  Aabb bounds;
  frame.info(slot).for_seen([&](const BodyShape& part, const Vec3f&) {
    const Aabb b = part.shape->bounds(frame.body(slot).pose * part.pose);
    if (b.min.allFinite() && b.max.allFinite()) bounds.include(b);
  });
  return bounds;
}

}  // namespace tumble
