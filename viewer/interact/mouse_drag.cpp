#include "viewer/interact/mouse_drag.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

constexpr double nearer_per_notch = 0.92;
constexpr double radians_per_pixel = 0.01;

Vec3 view_direction(const Camera& camera) {
  return (camera.target - camera.eye).normalized();
}

}  // namespace

void MouseDrag::begin(const Pick& pick, const Ray& ray, const Camera& camera) {
  held_ = Held{pick.body, pick.point_body};
  target_ = pick.x_world;
  depth_ = (target_ - ray.origin).dot(view_direction(camera));
  move(ray, camera);
}

void MouseDrag::move(const Ray& ray, const Camera& camera) {
  if (!held_) return;
  ray_ = ray;
  view_cosine_ = ray.direction.dot(view_direction(camera));
  if (!(view_cosine_ > 1e-3)) return;
  target_ = ray.origin + depth_ / view_cosine_ * ray.direction;
}

void MouseDrag::pull(double notches) {
  if (!held_ || !(view_cosine_ > 1e-3)) return;
  depth_ = std::max(depth_ * std::pow(nearer_per_notch, notches), 0.05);
  target_ = ray_.origin + depth_ / view_cosine_ * ray_.direction;
}

MouseSpringDef MouseDrag::def() const {
  MouseSpringDef def;
  if (!held_) return def;
  def.anchor.kind = Anchor::Kind::body;
  def.anchor.body = held_->body;
  def.anchor.point = held_->point_body;
  def.target = target_;
  return def;
}

Vec3 MouseDrag::turning(double dx, double dy, double dt, const Camera& camera) {
  const Vec3 forward = view_direction(camera);
  const Vec3 right = forward.cross(camera.up).normalized();
  const Vec3 up = right.cross(forward);
  Vec3 omega = radians_per_pixel / std::max(dt, 1e-3) * (dx * up + dy * right);
  const double limit = 2 * std::numbers::pi;
  if (omega.norm() > limit) omega *= limit / omega.norm();
  return omega;
}

}  // namespace tumble
