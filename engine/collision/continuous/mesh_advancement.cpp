#include "engine/collision/continuous/mesh_advancement.hpp"

#include "engine/collision/continuous/advancement.hpp"
#include "engine/collision/continuous/earliest_contact.hpp"
#include "engine/collision/continuous/vertex_core.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/core/stop.hpp"

#include <algorithm>

namespace tumble {
namespace {

constexpr double most_parts = 64;

TriangleCore triangle_core(const MeshSurface& s, uint32_t t) {
  return {s.mesh->corner(t, 0), s.mesh->corner(t, 1), s.mesh->corner(t, 2)};
}

/// The core of a triangle that moves with the mesh.
MovingCore moving_triangle(const TriangleCore& core, const MeshSurface& s, uint32_t t,
                           const Motion& m) {
  double lever = 0, radius = 0;
  for (size_t k = 0; k < 3; ++k) {
    lever = std::max(lever, m.offset.point(s.mesh->corner(t, k)).norm());
    radius = std::max(radius, s.mesh->corner(t, k).norm());
  }
  return {core, m, lever, radius};
}

TimeOfContact advance_cores(const MovingCore& a, const MovingCore& b, double t0, double t1,
                            double tolerance) {
  ConvexDistance distance(a, b, tolerance);
  return advance(distance, t0, t1, tolerance);
}

TimeOfContact advance_convex_mesh(const MovingPair& p) {
  const MeshSurface& b = p.surface_b();
  const MovingCore moving = p.core_a();
  const IntervalParts parts(p.t0(), p.t1(), 2 * p.drift(p.t0(), p.t1()), p.a.bounding_radius(),
                            most_parts);
  EarliestContact earliest(p.t1());
  std::vector<uint32_t> triangles, skipped;
  for (int part = 0; part < parts.count; ++part) {
    const double from = parts.from(part), to = parts.to(part), middle = 0.5 * (from + to);
    const Pose relative = p.motion_b.pose(middle).inverse() * p.motion_a.pose(middle);
    const double reach = p.drift(from, to) + 2 * p.tolerance;
    triangles.clear();
    b.tree->overlap(p.a.bounds(relative).inflated(reach), triangles);
    for (uint32_t t : triangles) {
      if (stop_requested()) break;
      if (std::binary_search(skipped.begin(), skipped.end(), t)) continue;
      const TriangleCore triangle = triangle_core(b, t);
      const MovingCore other = moving_triangle(triangle, b, t, p.motion_b);
      const TimeOfContact found =
          advance_cores(moving, other, from, std::min(to, earliest.time()), p.tolerance);
      if (earliest.offer(found, 0, t, part == 0)) skipped.push_back(t);
    }
    if (earliest.found()) break;
  }
  return earliest.answer();
}

TimeOfContact advance_mesh_mesh(const MovingPair& p) {
  const MeshSurface &a = p.surface_a(), &b = p.surface_b();
  const IntervalParts parts(p.t0(), p.t1(), 2 * p.drift(p.t0(), p.t1()),
                            0.25 * std::min(a.size, b.size), most_parts);
  EarliestContact earliest(p.t1());
  std::vector<TriangleIds> pairs, skipped;
  for (int part = 0; part < parts.count; ++part) {
    const double from = parts.from(part), to = parts.to(part), middle = 0.5 * (from + to);
    const Pose relative = p.motion_a.pose(middle).inverse() * p.motion_b.pose(middle);
    pairs.clear();
    box_pairs(*a.tree, *b.tree, relative, p.drift(from, to) + 2 * p.tolerance, pairs);
    for (const TriangleIds& ids : pairs) {
      if (stop_requested()) break;
      if (std::binary_search(skipped.begin(), skipped.end(), ids)) continue;
      const TriangleCore ta = triangle_core(a, ids.a), tb = triangle_core(b, ids.b);
      const MovingCore ma = moving_triangle(ta, a, ids.a, p.motion_a);
      const MovingCore mb = moving_triangle(tb, b, ids.b, p.motion_b);
      const TimeOfContact found =
          advance_cores(ma, mb, from, std::min(to, earliest.time()), p.tolerance);
      if (earliest.offer(found, ids.a, ids.b, part == 0)) skipped.push_back(ids);
    }
    if (earliest.found()) break;
  }
  return earliest.answer();
}

}  // namespace

TimeOfContact find_by_advancement(const MovingPair& p) {
  if (p.half_space()) {
    if (p.b.convex())
      return advance_half_space(p.motion_a, p.core_b(), p.t0(), p.t1(), p.tolerance);
    const VertexCore vertices(*p.surface_b().mesh);
    return advance_half_space(p.motion_a,
                              {vertices, p.motion_b, p.lever_b(), p.b.bounding_radius()}, p.t0(),
                              p.t1(), p.tolerance);
  }
  if (p.both_convex()) return advance_cores(p.core_a(), p.core_b(), p.t0(), p.t1(), p.tolerance);
  return p.a.convex() ? advance_convex_mesh(p) : advance_mesh_mesh(p);
}

}  // namespace tumble
