#include "engine/collision/gjk/gjk.hpp"
#include "engine/collision/narrow_phase.hpp"
#include "engine/collision/query.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/geometry/mesh_cleanup.hpp"
#include "engine/geometry/primitive_tests/point_in_object.hpp"

#include <utility>

namespace tumble {
namespace {

bool finite_placement(const Pose& pose) {
  return pose.x.allFinite() && pose.q.coeffs().allFinite();
}

/// Whether the rounded cores have a point in common.
bool cores_touch(const PlacedCore& A, const PlacedCore& B) {
  const double reach = A.core->rounding() + B.core->rounding();
  GjkOptions options;
  options.max_distance = reach;
  const GjkResult g = gjk(A, B, options);
  return g.status == GjkStatus::intersecting ||
         (g.status != GjkStatus::beyond && g.distance <= reach);
}

/// Whether a point is inside a closed mesh.
bool mesh_holds(const MeshSurface& s, const Vec3& p_mesh) {
  return s.closed && point_in_object(p_mesh, *s.tree).side != PointSide::outside;
}

/// Whether a solid contains any connected part of the mesh. If their surfaces do not cross, one
/// corner of each part decides. `inside` takes points in the mesh's frame.
template <class Inside>
bool holds_a_part(const MeshSurface& s, const Inside& inside) {
  size_t count = 0;
  const std::vector<uint32_t> part = connected_parts(*s.mesh, &count);
  size_t seen = 0;  // parts are numbered in order of their first triangle
  for (size_t t = 0; t < part.size() && seen < count; ++t) {
    if (part[t] != seen) continue;
    ++seen;
    if (inside(s.vertex(s.mesh->triangles[t][0]))) return true;
  }
  return false;
}

bool convex_mesh_overlap(const ConvexShape& a, const Pose& pose_a, const MeshSurface& s,
                         const Pose& pose_b) {
  const Pose a_in_mesh = pose_b.inverse() * pose_a;
  // Frames at A: nothing is lost far from the world's origin.
  const PlacedCore A(a, a_in_mesh.q, Vec3::Zero());
  thread_local std::vector<uint32_t> near;
  near.clear();
  s.tree->overlap(a.bounds(a_in_mesh).inflated(1e-12 * s.size), near);
  for (const uint32_t t : near) {
    const Triangle& v = s.mesh->triangles[t];
    const TriangleCore triangle(s.vertex(v[0]), s.vertex(v[1]), s.vertex(v[2]));
    if (cores_touch(A, PlacedCore(triangle, Quat::Identity(), -a_in_mesh.x))) return true;
  }
  if (mesh_holds(s, a_in_mesh.point(a.centre()))) return true;
  if (!a.bounds(a_in_mesh).overlaps(s.tree->bounds())) return false;
  return holds_a_part(s, [&](const Vec3& p) { return holds_point(a, a_in_mesh, p); });
}

bool meshes_overlap(const MeshSurface& a, const Pose& pose_a, const MeshSurface& b,
                    const Pose& pose_b) {
  const Pose b_in_a = pose_a.inverse() * pose_b;
  if (a.tree->intersects(*b.tree, b_in_a)) return true;
  if (a.closed && holds_a_part(b, [&](const Vec3& p) { return mesh_holds(a, b_in_a.point(p)); }))
    return true;
  return b.closed &&
         holds_a_part(a, [&](const Vec3& p) { return mesh_holds(b, b_in_a.inverse_point(p)); });
}

}  // namespace

bool holds_point(const Shape& shape, const Pose& pose, const Vec3& x_world) {
  const Vec3 p = pose.inverse_point(x_world);
  if (!p.allFinite()) return false;
  if (shape.convex()) {
    const auto near = closest_point(shape, Pose{}, p, 0);
    return near && near->distance <= 0;
  }
  if (const Polyhedral* polyhedral = shape.polyhedral())
    return mesh_holds(polyhedral->surface(), p);
  return p.y() <= 0;
}

bool overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  if (!finite_placement(pose_a) || !finite_placement(pose_b)) return false;
  if (a.is_half_space() || b.is_half_space()) {
    thread_local std::vector<Manifold> contacts;
    contacts.clear();
    collide(a, pose_a, b, pose_b, 0, contacts);
    return !contacts.empty();
  }
  const ConvexShape *ca = a.convex(), *cb = b.convex();
  if (ca && cb)
    return cores_touch(PlacedCore(*ca, pose_a.q, Vec3::Zero()),
                       PlacedCore(*cb, pose_b.q, pose_b.x - pose_a.x));
  if (ca) return convex_mesh_overlap(*ca, pose_a, b.polyhedral()->surface(), pose_b);
  if (cb) return convex_mesh_overlap(*cb, pose_b, a.polyhedral()->surface(), pose_a);
  return meshes_overlap(a.polyhedral()->surface(), pose_a, b.polyhedral()->surface(), pose_b);
}

}  // namespace tumble
