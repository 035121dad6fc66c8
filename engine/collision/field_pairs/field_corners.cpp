#include "engine/collision/field_pairs/field_corners.hpp"

#include "engine/collision/feature_key.hpp"
#include "engine/collision/field_pairs/convex_in_field.hpp"
#include "engine/collision/field_pairs/surface_in_field.hpp"
#include "engine/collision/mesh_pairs/near_triangles.hpp"

#include <limits>

namespace tumble {
namespace {

/// Depth up to which corners below a mesh are contacts, relative to the smaller size: as for mesh
/// against mesh.
constexpr double reach_of_size = 0.01;

}  // namespace

void corners_in_convex(const PlacedSurface& corners, const ConvexShape& solid, const Pose& pose,
                       double margin, std::vector<FeatureContact>& contacts) {
  const MeshSurface& s = corners.s;
  thread_local std::vector<uint32_t> near;
  near.clear();
  s.tree->overlap(solid.bounds(pose).inflated(margin), near);
  for (const uint32_t t : near)
    for (unsigned k = 0; k < 3; ++k) {
      if (!(s.owned[t] & (1u << k))) continue;
      const uint32_t v = s.mesh->triangles[t][k];
      const SurfacePoint at = nearest_of(solid, pose.inverse_point(s.vertex(v)));
      if (at.distance > margin) continue;
      const Vec3 n = pose.direction(at.normal);
      const double cone = at.distance < 0 ? tolerances::cone_inside : tolerances::cone_in_front;
      if (!sticks_out_along(corners, v, -n, cone)) continue;
      contacts.push_back({s.vertex(v) - 0.5 * at.distance * n, n, at.distance,
                          feature_key(FeaturePair::face_vertex, 0, v)});
    }
}

void corners_on_mesh(const PlacedSurface& corners, const PlacedSurface& mesh, double margin,
                     std::vector<FeatureContact>& contacts) {
  thread_local std::vector<TriangleIds> pairs;
  thread_local std::vector<uint32_t> run;
  thread_local std::vector<SunkVertex> sunk;
  pairs.clear(), sunk.clear();
  const double reach = std::max(margin, reach_of_size * std::min(corners.s.size, mesh.s.size));
  near_triangles(corners, mesh, reach, std::numeric_limits<size_t>::max(), nullptr, pairs);
  const ContactRange range{margin, reach, tolerances::cone_inside};
  for (size_t first = 0; first < pairs.size();) {
    const uint32_t t = pairs[first].a;
    run.clear();
    for (; first < pairs.size() && pairs[first].a == t; ++first) run.push_back(pairs[first].b);
    for (unsigned k = 0; k < 3; ++k)
      if (corners.s.owned[t] & (1u << k))
        vertex_contacts(corners, corners.s.mesh->triangles[t][k], mesh, run, range, contacts, sunk);
  }
}

}  // namespace tumble
