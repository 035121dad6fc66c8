#pragma once
#include "engine/geometry/constructions/ray_casts.hpp"
#include "engine/math/matrix4.hpp"
#include "engine/math/types.hpp"

#include <array>

namespace tumble {

/// A perspective camera in world axes.
struct Camera {
  Vec3 eye = Vec3(6, 4, 8);  ///< [m]
  Vec3 target = Vec3(0, 1, 0);
  Vec3 up = Vec3::UnitY();
  double fov_deg = 40;  ///< full vertical angle of view
  double near = 0;      ///< [m]; 0: chosen from the scene
  double far = 0;       ///< [m]; 0: chosen from the scene
};

/// The same camera with its picture extended up and down: tan(fov / 2) is multiplied by `ratio`.
/// Used for a narrower picture beside a wide one of `camera`: both show the same width of the world
/// when `ratio` is the aspect of the wide one over that of the narrow one.
Camera heightened(const Camera& camera, double ratio);

/// World to camera axes (x right, y up, looking along -z). Any finite input gives a proper frame:
/// if the eye is on the target the camera looks along -z, and if `up` is along the view another
/// axis takes its place.
Mat4 view_matrix(const Camera& camera);
/// Camera axes to clip space with depth -1..1; `aspect` is width / height.
Mat4 perspective_matrix(double fov_deg, double aspect, double near, double far);
Mat4 orthographic_matrix(double left, double right, double bottom, double top, double near,
                         double far);

/// The ray from the eye through a point of the picture: x to the right and y down [px], where (0,
/// 0) is the outer corner of the top left pixel.
Ray pixel_ray(const Camera& camera, double x, double y, double width, double height);
/// Picture coordinates [px] of a world point and its depth along the view [m] (<= 0: behind).
Vec3 project(const Camera& camera, const Vec3& x_world, double width, double height);

/// The nearest camera that sees all corners of `bounds` from direction `from` (which need not be
/// unit), with a margin, and centred on them.
Camera frame_bounds(const Aabb& bounds, const Vec3& from, double fov_deg, double aspect);

/// The six planes of a clip volume, (n, d) with n.x + d >= 0 inside, n of unit length.
struct Frustum {
  std::array<Vec4, 6> planes;
  bool sees_sphere(const Vec3& centre, double radius) const;
};
Frustum frustum_of(const Mat4& clip_from_world);

}  // namespace tumble
