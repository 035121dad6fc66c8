#include "engine/collision/narrow_phase.hpp"

#include "engine/collision/convex_pairs/box_box.hpp"
#include "engine/collision/convex_pairs/capsule_box.hpp"
#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/convex_pairs/half_space_pairs.hpp"
#include "engine/collision/convex_pairs/polyhedron_pairs.hpp"
#include "engine/collision/convex_pairs/rounded_pairs.hpp"
#include "engine/collision/mesh_pairs/convex_mesh.hpp"
#include "engine/collision/mesh_pairs/mesh_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr size_t type_count = 8;

/// The routine for an ordered pair of types; `swap` when it wants them the other way round.
struct Route {
  CollidePair collide = nullptr;
  bool swap = false;
};

using Routes = std::array<std::array<Route, type_count>, type_count>;

void set(Routes& routes, ShapeType a, ShapeType b, CollidePair collide) {
  routes[size_t(a)][size_t(b)] = {collide, false};
  if (a != b) routes[size_t(b)][size_t(a)] = {collide, true};
}

Routes make_routes() {
  using enum ShapeType;
  Routes r{};
  const std::array convex{sphere, capsule, box, cylinder, ellipsoid, convex_hull};
  for (size_t i = 0; i < convex.size(); ++i)
    for (size_t j = i; j < convex.size(); ++j) set(r, convex[i], convex[j], collide_convex_convex);
  for (ShapeType c : convex) set(r, half_space, c, collide_half_space_convex);
  for (ShapeType c : {sphere, capsule, cylinder, ellipsoid})
    set(r, c, triangle_mesh, collide_convex_mesh);
  for (ShapeType c : {box, convex_hull}) set(r, c, triangle_mesh, collide_mesh_mesh);
  set(r, half_space, triangle_mesh, collide_half_space_mesh);
  set(r, triangle_mesh, triangle_mesh, collide_mesh_mesh);
  set(r, sphere, sphere, collide_sphere_sphere);
  set(r, sphere, capsule, collide_sphere_capsule);
  set(r, capsule, capsule, collide_capsule_capsule);
  set(r, sphere, box, collide_sphere_box);
  set(r, capsule, box, collide_capsule_box);
  set(r, box, box, collide_box_box);
  return r;
}

/// V-Clip where both shapes are polyhedra.
Routes make_v_clip_routes() {
  using enum ShapeType;
  Routes r = make_routes();
  set(r, box, box, collide_polyhedra);
  set(r, box, convex_hull, collide_polyhedra);
  set(r, convex_hull, convex_hull, collide_polyhedra);
  return r;
}

bool finite(const Pose& p) {
  return p.x.allFinite() && p.q.coeffs().allFinite();
}

void collide_by(const Routes& routes, const Shape& a, const Pose& pose_a, const Shape& b,
                const Pose& pose_b, const ContactQuery& query, std::vector<Manifold>& out) {
  const double radii = a.bounding_radius() + b.bounding_radius();
  const double reach = radii + query.margin;
  const double between2 = (pose_b.x - pose_a.x).squaredNorm();
  if (query.apart) *query.apart = query.margin;
  if (between2 > reach * reach) {
    if (query.apart) {
      const double bound = (1 - 1e-14) * std::sqrt(between2) - (1 + 1e-14) * radii;
      *query.apart = std::max(query.margin, bound);
    }
    return;
  }
  if (!finite(pose_a) || !finite(pose_b) || !std::isfinite(query.margin)) return;
  const Route& route = routes[size_t(a.type())][size_t(b.type())];
  if (!route.collide) return;
  if (!route.swap) {
    route.collide(ShapePair(a, pose_a, b, pose_b, query), out);
    return;
  }
  ContactQuery swapped = query;
  ClosestFeatures start;
  if (query.start) {
    start = {(*query.start)[1], (*query.start)[0]};
    swapped.start = &start;
  }
  const size_t first = out.size();
  route.collide(ShapePair(b, pose_b, a, pose_a, swapped), out);
  for (size_t i = first; i < out.size(); ++i) {
    out[i].normal = -out[i].normal;
    std::swap(out[i].closest[0], out[i].closest[1]);
  }
}

void collide_with_v_clip(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                         const ContactQuery& query, std::vector<Manifold>& out) {
  static const Routes routes = make_v_clip_routes();
  collide_by(routes, a, pose_a, b, pose_b, query, out);
}

}  // namespace

void collide(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
             const ContactQuery& query, std::vector<Manifold>& out) {
  static const Routes routes = make_routes();
  collide_by(routes, a, pose_a, b, pose_b, query, out);
}

const std::vector<NarrowPhaseEntry>& all_narrow_phases() {
  static const std::vector<NarrowPhaseEntry> list{{"gjk", collide},
                                                  {"v_clip", collide_with_v_clip}};
  return list;
}

}  // namespace tumble
