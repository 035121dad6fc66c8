#include "viewer/app/scenes/camera_path.hpp"

#include <algorithm>

namespace tumble {
namespace {

/// What of a camera moves: eye, target, field of view.
using CameraNumbers = Eigen::Matrix<double, 7, 1>;

CameraNumbers numbers_of(const Camera& camera) {
  CameraNumbers out;
  out << camera.eye, camera.target, camera.fov_deg;
  return out;
}

CameraNumbers key_slope(const std::vector<CameraKey>& path, size_t i) {
  if (i == 0 || i + 1 == path.size()) return CameraNumbers::Zero();
  const double before = path[i].time - path[i - 1].time, after = path[i + 1].time - path[i].time;
  const CameraNumbers here = numbers_of(path[i].camera);
  const CameraNumbers from = (here - numbers_of(path[i - 1].camera)) / before;
  const CameraNumbers to = (numbers_of(path[i + 1].camera) - here) / after;
  return (after * from + before * to) / (before + after);
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
  out.eye = at.head<3>();
  out.target = at.segment<3>(3);
  out.fov_deg = at[6];
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
