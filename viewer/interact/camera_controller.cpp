#include "viewer/interact/camera_controller.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double turn_per_pixel = 2 * pi / 1200;
constexpr double pitch_limit = 89.0 / 180 * pi;  // at the pole the yaw is undefined
constexpr double least_distance = 0.02, largest_distance = 5000;
constexpr double zoom_per_notch = 0.88;
constexpr double follow_rate = 18;  // covers 97 % of the way in 0.2 s [1/s]

double half_tan(double fov_deg) {
  return std::tan(0.5 * fov_deg * pi / 180);
}

/// `from` plus a multiple of 2 pi, nearest to `to` [rad].
double unwrap(double from, double to) {
  return from + 2 * pi * std::round((to - from) / (2 * pi));
}

}  // namespace

Vec3 CameraController::to_eye(const View& v) {
  const double c = std::cos(v.pitch);
  return {c * std::sin(v.yaw), std::sin(v.pitch), c * std::cos(v.yaw)};
}

void CameraController::aim(const Camera& camera) {
  const Vec3 d = camera.eye - camera.target;
  const double length = d.norm();
  goal_.pivot = camera.target;
  if (length > 0 && std::isfinite(length)) {
    goal_.distance = length;
    goal_.yaw = d.x() != 0 || d.z() != 0 ? std::atan2(d.x(), d.z()) : 0;
    goal_.pitch = std::asin(std::clamp(d.y() / length, -1.0, 1.0));
  }
  fov_deg_ = camera.fov_deg;
  near_ = camera.near;
  far_ = camera.far;
}

void CameraController::set(const Camera& camera) {
  aim(camera);
  arrive();
}

void CameraController::go_to(const Camera& camera) {
  aim(camera);
  goal_.yaw = unwrap(goal_.yaw, now_.yaw);
  keep_proper();
}

void CameraController::set_floor(std::optional<double> height) {
  floor_ = height;
  if (height && goal_.pivot.y() + goal_.distance * to_eye(goal_).y() < *height) floor_.reset();
}

/// Raises the pitch until the eye is slightly above the floor.
void CameraController::stay_above_floor() {
  if (!floor_) return;
  constexpr double clearance = 0.01;  // over the distance to the pivot [-]
  double least = clearance + (*floor_ - goal_.pivot.y()) / goal_.distance;
  if (least > std::sin(pitch_limit)) {
    goal_.pivot.y() = *floor_;
    least = clearance;
  }
  if (least > -1) goal_.pitch = std::max(goal_.pitch, std::asin(least));
}

void CameraController::orbit(double dx, double dy) {
  goal_.yaw -= dx * turn_per_pixel;
  goal_.pitch += dy * turn_per_pixel;
  keep_proper();
  stay_above_floor();
}

void CameraController::pan(double dx, double dy, double view_height) {
  const Vec3 back = to_eye(goal_);
  const Vec3 right(std::cos(goal_.yaw), 0, -std::sin(goal_.yaw));
  const Vec3 up = back.cross(right);
  const double metres =
      2 * goal_.distance * heightening_ * half_tan(fov_deg_) / std::max(view_height, 1.0);
  const double before = goal_.pivot.y();
  goal_.pivot += metres * (-dx * right + dy * up);
  if (floor_) goal_.pivot.y() = std::max(goal_.pivot.y(), std::min(before, *floor_));
  stay_above_floor();
}

void CameraController::zoom(double notches) {
  goal_.distance *= std::pow(zoom_per_notch, notches);
  keep_proper();
  stay_above_floor();
}

void CameraController::look(double dx, double dy) {
  const Vec3 eye = goal_.pivot + goal_.distance * to_eye(goal_);
  goal_.yaw -= 0.5 * dx * turn_per_pixel;
  goal_.pitch += 0.5 * dy * turn_per_pixel;
  keep_proper();
  goal_.pivot = eye - goal_.distance * to_eye(goal_);
}

void CameraController::fly(const Vec3& move, double dt, bool fast) {
  const Vec3 right(std::cos(goal_.yaw), 0, -std::sin(goal_.yaw));
  // The speed grows with the distance to the pivot, so that a scene of any size is crossed in
  // seconds.
  const double speed = (0.6 * goal_.distance + 1) * (fast ? 4 : 1);
  goal_.pivot +=
      speed * dt * (move.x() * right + move.y() * Vec3::UnitY() - move.z() * to_eye(goal_));
  if (!floor_) return;
  // The eye slides along the floor, and its direction of view stays.
  const double under = *floor_ - (goal_.pivot.y() + goal_.distance * to_eye(goal_).y());
  goal_.pivot.y() += std::max(under, 0.0);
}

void CameraController::carry(const Vec3& shift) {
  if (!shift.allFinite()) return;
  goal_.pivot += shift;
  now_.pivot += shift;
  publish();
}

void CameraController::focus(const Vec3& point) {
  const Vec3 eye = goal_.pivot + goal_.distance * to_eye(goal_);
  const Vec3 d = eye - point;
  const double length = d.norm();
  goal_.pivot = point;
  if (!(length > least_distance)) return keep_proper();
  goal_.distance = length;
  goal_.yaw = unwrap(std::atan2(d.x(), d.z()), goal_.yaw);
  goal_.pitch = std::asin(std::clamp(d.y() / length, -1.0, 1.0));
  keep_proper();
}

void CameraController::focus(const Aabb& bounds, double aspect) {
  if (bounds.empty() || !bounds.extent().allFinite()) return;
  const Camera fitted = frame_bounds(bounds, to_eye(goal_), seen().fov_deg, aspect);
  goal_.pivot = fitted.target;
  goal_.distance = (fitted.eye - fitted.target).norm();
  keep_proper();
  stay_above_floor();
}

void CameraController::keep_proper() {
  goal_.pitch = std::clamp(goal_.pitch, -pitch_limit, pitch_limit);
  goal_.distance = std::clamp(goal_.distance, least_distance, largest_distance);
}

void CameraController::update(double dt) {
  const double s = 1 - std::exp(-follow_rate * std::max(dt, 0.0));
  // A viewer sees the motion of the eye: eye and pivot approach the goal, and the rest is derived
  // from them.
  const Vec3 eye_now = now_.pivot + now_.distance * to_eye(now_);
  const Vec3 eye_goal = goal_.pivot + goal_.distance * to_eye(goal_);
  const bool same_pivot = (goal_.pivot - now_.pivot).norm() < 1e-9;
  now_.pivot += s * (goal_.pivot - now_.pivot);
  now_.yaw += s * (goal_.yaw - now_.yaw);
  now_.pitch += s * (goal_.pitch - now_.pitch);
  if (same_pivot) {
    now_.distance *= std::pow(goal_.distance / now_.distance, s);
  } else {
    const Vec3 eye = eye_now + s * (eye_goal - eye_now);
    const Vec3 d = eye - now_.pivot;
    now_.distance = std::max(d.norm(), least_distance);
    now_.yaw = unwrap(std::atan2(d.x(), d.z()), goal_.yaw);
    now_.pitch = std::asin(std::clamp(d.y() / now_.distance, -1.0, 1.0));
  }
  publish();
}

void CameraController::arrive() {
  keep_proper();
  now_ = goal_;
  publish();
}

void CameraController::publish() {
  camera_.target = now_.pivot;
  camera_.eye = now_.pivot + now_.distance * to_eye(now_);
  camera_.up = Vec3::UnitY();
  camera_.fov_deg = fov_deg_;
  camera_.near = near_;
  camera_.far = far_;
}

}  // namespace tumble
