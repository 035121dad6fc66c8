#include "viewer/app/scenes/camera_path.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// The values of a camera that change along a path: eye, target, field of view.
struct CameraNumbers {
  Vec3 eye = Vec3::Zero(), target = Vec3::Zero();
  double fov_deg = 0;

  friend CameraNumbers operator+(const CameraNumbers& a, const CameraNumbers& b) {
    return {a.eye + b.eye, a.target + b.target, a.fov_deg + b.fov_deg};
  }
  friend CameraNumbers operator*(double s, const CameraNumbers& a) {
    return {s * a.eye, s * a.target, s * a.fov_deg};
  }
};

CameraNumbers numbers_of(const Camera& camera) {
  return {camera.eye, camera.target, camera.fov_deg};
}

/// Their mean rate of change from one key to another.
CameraNumbers slope(const CameraKey& from, const CameraKey& to) {
  return (1 / (to.time - from.time)) * (numbers_of(to.camera) + (-1) * numbers_of(from.camera));
}

CameraNumbers key_slope(const std::vector<CameraKey>& path, size_t i) {
  if (i == 0 || i + 1 == path.size()) return {};
  const double before = path[i].time - path[i - 1].time, after = path[i + 1].time - path[i].time;
  return (1 / (before + after)) *
         (after * slope(path[i - 1], path[i]) + before * slope(path[i], path[i + 1]));
}

}  // namespace

Camera camera_at(const std::vector<CameraKey>& path, double time) {
  if (time <= path.front().time) return path.front().camera;
  if (time >= path.back().time) return path.back().camera;
  const auto next = std::ranges::upper_bound(path, time, {}, &CameraKey::time);
  const auto b = size_t(next - path.begin()), a = b - 1;
  const double span = path[b].time - path[a].time, u = (time - path[a].time) / span;
  const double u2 = u * u, u3 = u2 * u;
  const CameraNumbers at = (2 * u3 - 3 * u2 + 1) * numbers_of(path[a].camera) +
                           (u3 - 2 * u2 + u) * span * key_slope(path, a) +
                           (3 * u2 - 2 * u3) * numbers_of(path[b].camera) +
                           (u3 - u2) * span * key_slope(path, b);
  Camera out = path[a].camera;
  out.eye = at.eye;
  out.target = at.target;
  out.fov_deg = at.fov_deg;
  return out;
}

std::vector<CameraKey> carried_along(
    const std::vector<CameraKey>& path,
    const std::function<std::optional<Vec3>(const std::string& body)>& place_of) {
  std::vector<CameraKey> out = path;
  for (CameraKey& key : out) {
    if (key.follow.empty()) continue;
    const auto x = place_of(key.follow);
    if (!x) continue;
    key.camera.eye += *x - key.follow_x;
    key.camera.target += *x - key.follow_x;
  }
  return out;
}

}  // namespace tumble
