#include "engine/collision/query.hpp"

#include "engine/collision/gjk/epa.hpp"
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/collision/shapes/convex_shape.hpp"
#include "engine/collision/shapes/polyhedral.hpp"

#include <cmath>

namespace tumble {
namespace {

class PointCore final : public ConvexCore {
 public:
  PointCore() : ConvexCore(CoreView::of_box(Vec3::Zero())) {}
  Vec3 support(const Vec3&) const override { return Vec3::Zero(); }
  void supporting_face(const Vec3&, SupportingFace& face) const override {
    face.count = 0;
    face.add(Vec3::Zero(), 0);
  }
};

/// All in the shape's frame.
ClosestPoint nearest_on_convex(const ConvexShape& shape, const Vec3& p) {
  if (const auto exact = shape.nearest(p)) return {exact->x, exact->normal, exact->distance, 0};
  const PointCore point;
  const PlacedCore A(shape, Quat::Identity(), Vec3::Zero()), B(point, Quat::Identity(), p);
  const GjkResult near = gjk(A, B);
  ClosestPoint c;
  if (near.status != GjkStatus::intersecting) {
    c.normal = near.normal;
    c.distance = near.distance - shape.rounding();
  } else {
    const EpaResult deep = epa(A, B, near.simplex);
    c.normal = deep.normal;
    c.distance = -deep.depth - shape.rounding();
  }
  c.x_world = p - c.distance * c.normal;
  return c;
}

std::optional<ClosestPoint> nearest_on_mesh(const MeshSurface& s, const Vec3& p, double reach) {
  const auto near = s.tree->closest(p, reach);
  if (!near) return std::nullopt;
  const uint32_t t = near->triangle;
  const NearestFeature side = nearest_feature(s, p, {&t, 1}, reach);
  ClosestPoint c;
  c.triangle = t;
  c.x_world = near->point;
  c.distance = std::sqrt(near->squared_distance);
  c.normal = c.distance > 1e-9 * s.size ? Vec3((p - near->point) / c.distance) : side.normal;
  if (side.inside) {
    c.distance = -c.distance;
    if (c.distance < -1e-9 * s.size) c.normal = -c.normal;
  }
  return c;
}

}  // namespace

std::optional<RayHit> ray_cast(const Shape& shape, const Pose& pose, const Ray& ray_world,
                               double t_max) {
  auto hit = shape.ray_cast(pose.inverse_point(ray_world.origin),
                            pose.inverse_direction(ray_world.direction), t_max);
  if (hit) hit->normal = pose.direction(hit->normal);
  return hit;
}

std::optional<ClosestPoint> closest_point(const Shape& shape, const Pose& pose, const Vec3& x_world,
                                          double max_distance) {
  const Vec3 p = pose.inverse_point(x_world);
  if (!p.allFinite()) return std::nullopt;
  std::optional<ClosestPoint> c;
  if (const ConvexShape* convex = shape.convex()) {
    c = nearest_on_convex(*convex, p);
  } else if (const Polyhedral* polyhedral = shape.polyhedral()) {
    c = nearest_on_mesh(polyhedral->surface(), p, max_distance);
    // behind the surface every depth counts as near
    if (!c) {
      c = nearest_on_mesh(polyhedral->surface(), p, std::numeric_limits<double>::infinity());
      if (c && c->distance > 0) c.reset();
    }
  } else {
    c = ClosestPoint{{p.x(), 0, p.z()}, Vec3::UnitY(), p.y(), 0};
  }
  if (!c || c->distance > max_distance) return std::nullopt;
  c->x_world = pose.point(c->x_world);
  c->normal = pose.direction(c->normal);
  return c;
}

}  // namespace tumble
