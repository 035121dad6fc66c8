#pragma once
#include "engine/geometry/constructions/closest_points.hpp"
#include "engine/geometry/triangle_mesh.hpp"

/// The results of every kind of hierarchy are decided by these functions, triangle by triangle.
namespace tumble {

/// A triangle of one mesh and one of another (or of the same).
struct TriangleIds {
  uint32_t a, b;
  friend bool operator==(TriangleIds, TriangleIds) = default;
  friend auto operator<=>(TriangleIds, TriangleIds) = default;
};

using TriangleCorners = std::array<Vec3, 3>;

/// The pose of one mesh in another's frame, with its rotation as a matrix.
struct RelativePose {
  Mat3 R = Mat3::Identity();
  Vec3 x = Vec3::Zero();

  RelativePose() = default;
  explicit RelativePose(const Pose& pose) : R(pose.q.toRotationMatrix()), x(pose.x) {}
  Vec3 point(const Vec3& p) const { return R * p + x; }
};

inline TriangleCorners corners(const TriangleMesh& mesh, uint32_t t) {
  return {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
}
inline TriangleCorners corners(const TriangleMesh& mesh, uint32_t t, const RelativePose& at) {
  return {at.point(mesh.corner(t, 0)), at.point(mesh.corner(t, 1)), at.point(mesh.corner(t, 2))};
}

/// Whether two triangles have a point in common: the answer of triangles_intersect (exact), after a
/// filter in double with a proven error bound that decides nearly all pairs.
bool triangles_meet(const TriangleCorners& a, const TriangleCorners& b);

/// Whether two triangles are at most `margin` apart; with margin 0, triangles_meet.
bool triangles_near(const TriangleCorners& a, const TriangleCorners& b, double margin);

/// Whether a triangle and a box have a point in common.
bool triangle_meets_box(const TriangleMesh& mesh, uint32_t t, const Aabb& box);

/// Whether two triangles of one mesh share a vertex number.
bool neighbours(const TriangleMesh& mesh, uint32_t a, uint32_t b);

/// Bounds how the points of a mesh move: at any time, for some s in [0, 1] (the same for all points
/// and for both partners of a query), a point that started at p is at
/// centre + s translation + Q (p - centre), with Q a rotation about any axis by at most `angle`.
/// A rigid motion at constant velocity and constant angular velocity is of this kind.
struct MotionBound {
  Vec3 translation = Vec3::Zero();
  Vec3 centre = Vec3::Zero();
  double angle = 0;  ///< [rad], not negative

  /// Bound of a point's displacement by rotation, per distance from the centre: the chord 2
  /// sin(angle / 2), bounded by the arc and by the diameter.
  double chord() const { return angle < 2 ? angle : 2; }
};

/// Whether triangle a and triangle b, swept along `translation` (b's minus a's), come within
/// `reach` of each other; `reach` is the margin plus the bounds of the displacements of both by
/// rotation. Decided by the distance of a from the prism that b sweeps; true if in doubt.
bool swept_triangles_near(const TriangleCorners& a, const TriangleCorners& b,
                          const Vec3& translation, double reach);

/// Bound of the displacement of a triangle's points by rotation.
double turned_reach(const TriangleCorners& t, const MotionBound& motion);

/// Whether the bounding boxes of triangle `a` and triangle `b`, the latter mapped by `pose`, are
/// within `margin` along each axis of either frame.
bool triangle_boxes_near(const TriangleMesh& mesh_a, uint32_t a, const TriangleMesh& mesh_b,
                         uint32_t b, const Pose& pose, double margin);

}  // namespace tumble
