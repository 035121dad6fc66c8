#include "viewer/render/camera.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble {
namespace {

// Uses the deterministic functions instead of libm, since pictures are compared across machines.
double half_tan(double fov_deg) {
  const double half = std::clamp(fov_deg, 0.1, 175.0) * det::pi / 360;
  return det::sin(half) / det::cos(half);
}

struct ViewAxes {
  Vec3 right, up, back;
};

ViewAxes frame_of(const Camera& c) {
  Vec3 back = c.eye - c.target;
  if (!back.allFinite() || back.norm() < 1e-12) back = Vec3::UnitZ();
  back.normalize();
  Vec3 right = c.up.cross(back);
  if (!right.allFinite() || right.norm() < 1e-9 * std::max(1e-9, c.up.norm())) {
    const Vec3 other = std::fabs(back.y()) < 0.9 ? Vec3::UnitY() : Vec3::UnitZ();
    right = other.cross(back);
  }
  right.normalize();
  return {right, back.cross(right), back};
}

}  // namespace

Camera heightened(const Camera& camera, double ratio) {
  if (ratio == 1) return camera;  // exactly the same bits
  Camera out = camera;
  out.fov_deg = det::atan(ratio * half_tan(camera.fov_deg)) * 360 / det::pi;
  return out;
}

Mat4 view_matrix(const Camera& camera) {
  const ViewAxes f = frame_of(camera);
  const Mat3 axes = Mat3::from_rows(f.right, f.up, f.back);
  return Mat4::affine(axes, -(axes * camera.eye));
}

Mat4 perspective_matrix(double fov_deg, double aspect, double near, double far) {
  const double t = half_tan(fov_deg);
  Mat4 m = Mat4::Zero();
  m(0, 0) = 1 / (t * aspect);
  m(1, 1) = 1 / t;
  m(2, 2) = -(far + near) / (far - near);
  m(2, 3) = -2 * far * near / (far - near);
  m(3, 2) = -1;
  return m;
}

Mat4 orthographic_matrix(double left, double right, double bottom, double top, double near,
                         double far) {
  Mat4 m = Mat4::Identity();
  m(0, 0) = 2 / (right - left);
  m(1, 1) = 2 / (top - bottom);
  m(2, 2) = -2 / (far - near);
  m(0, 3) = -(right + left) / (right - left);
  m(1, 3) = -(top + bottom) / (top - bottom);
  m(2, 3) = -(far + near) / (far - near);
  return m;
}

Ray pixel_ray(const Camera& camera, double x, double y, double width, double height) {
  const ViewAxes f = frame_of(camera);
  const double t = half_tan(camera.fov_deg);
  const double sx = (2 * x / width - 1) * t * width / height;
  const double sy = (1 - 2 * y / height) * t;
  return {camera.eye, (sx * f.right + sy * f.up - f.back).normalized()};
}

Vec3 project(const Camera& camera, const Vec3& x_world, double width, double height) {
  const ViewAxes f = frame_of(camera);
  const Vec3 d = x_world - camera.eye;
  const double depth = -f.back.dot(d);
  const double t = half_tan(camera.fov_deg);
  const double scale = 1 / (t * std::max(std::fabs(depth), 1e-12));
  const double sx = f.right.dot(d) * scale * height / width;
  const double sy = f.up.dot(d) * scale;
  return {0.5 * (1 + sx) * width, 0.5 * (1 - sy) * height, depth};
}

// With d the distance of the eye along the view from the centre of the box, and (x, y, z) a corner
// in the camera's axes there, the corner is right of the left edge and left of the right one when
// |x - tx| <= tan (d - z). Of all corners these are two linear bounds on (tx, d), likewise for y:
// the nearest eye and where it looks follow in closed form.
Camera frame_bounds(const Aabb& bounds, const Vec3& from, double fov_deg, double aspect) {
  Camera c;
  c.fov_deg = fov_deg;
  if (bounds.empty()) return c;
  constexpr double margin = 1.1;  // of the picture to the box in it
  constexpr double least = 1e-3;  // least distance [m]
  const double t = half_tan(fov_deg) / margin;
  c.target = bounds.centre();
  c.eye = c.target + (from.norm() > 0 ? Vec3(from.normalized()) : Vec3(0, 0, 1));
  const ViewAxes f = frame_of(c);
  const Vec3 half = (0.5 * bounds.extent()).cwiseMax(least);
  const auto fit = [&](const Vec3& axis, double tangent) {
    double right = 0, left = 0;
    for (int k = 0; k < 8; ++k) {
      const Vec3 x(k & 1 ? half.x() : -half.x(), k & 2 ? half.y() : -half.y(),
                   k & 4 ? half.z() : -half.z());
      right = std::max(right, axis.dot(x) / tangent + f.back.dot(x));
      left = std::max(left, -axis.dot(x) / tangent + f.back.dot(x));
    }
    return std::pair(0.5 * (right + left), 0.5 * (right - left) * tangent);
  };
  const auto [wide, tx] = fit(f.right, t * aspect);
  const auto [high, ty] = fit(f.up, t);
  c.target += tx * f.right + ty * f.up;
  c.eye = c.target + std::max(wide, high) * f.back;
  return c;
}

Frustum frustum_of(const Mat4& m) {
  Frustum f;
  for (int i = 0; i < 6; ++i) {
    const Vec4 row = m.row(3) + (i % 2 ? -1.0 : 1.0) * m.row(i / 2);
    f.planes[size_t(i)] = row / row.head<3>().norm();
  }
  return f;
}

bool Frustum::sees_sphere(const Vec3& centre, double radius) const {
  for (const Vec4& p : planes)
    if (p.head<3>().dot(centre) + p.w() < -radius) return false;
  return true;
}

}  // namespace tumble
