#include "engine/collision/narrow_phase.hpp"

#include "engine/collision/convex_pairs/box_box.hpp"
#include "engine/collision/convex_pairs/capsule_box.hpp"
#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/convex_pairs/half_space_pairs.hpp"
#include "engine/collision/convex_pairs/polyhedron_pairs.hpp"
#include "engine/collision/convex_pairs/rounded_pairs.hpp"
#include "engine/collision/field_pairs/field_pairs.hpp"
#include "engine/collision/mesh_pairs/convex_mesh.hpp"
#include "engine/collision/mesh_pairs/mesh_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

/// The routine for an ordered pair of types; `swap` if it takes them in the other order.
struct Route {
  CollidePair collide = nullptr;
  bool swap = false;
};

using Routes = std::array<std::array<Route, shape_type_count>, shape_type_count>;

void set(Routes& routes, ShapeType a, ShapeType b, CollidePair collide) {
  routes[size_t(a)][size_t(b)] = {collide, false};
  if (a != b) routes[size_t(b)][size_t(a)] = {collide, true};
}

/// Sets the routines that follow from the families of two shapes.
void set_usual(Routes& routes, const ShapeEntry& a, const ShapeEntry& b) {
  using enum ShapeFamily;
  if (a.family > b.family) return set_usual(routes, b, a);
  if (a.family == convex && b.family == convex)
    return set(routes, a.type, b.type, collide_convex_convex);
  if (a.family == half_space && b.family == convex)
    return set(routes, a.type, b.type, collide_half_space_convex);
  if (a.family == half_space && b.family == mesh)
    return set(routes, a.type, b.type, collide_half_space_mesh);
  if (b.family == mesh)
    set(routes, a.type, b.type, a.polyhedral ? collide_mesh_mesh : collide_convex_mesh);
}

Routes make_routes() {
  using enum ShapeType;
  Routes r{};
  const std::vector<ShapeEntry>& all = all_shapes();
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = i; j < all.size(); ++j) set_usual(r, all[i], all[j]);
  // A half-space is tested against a field's mesh, which is exact.
  for (const ShapeEntry& e : all)
    if (e.family == ShapeFamily::convex) set(r, e.type, distance_field, collide_convex_field);
  set(r, triangle_mesh, distance_field, collide_mesh_field);
  set(r, distance_field, distance_field, collide_field_field);
  // Pairs with closed forms.
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
  Routes r = make_routes();
  const std::vector<ShapeEntry>& all = all_shapes();
  const auto polyhedron = [](const ShapeEntry& e) {
    return e.polyhedral && e.family == ShapeFamily::convex;
  };
  for (size_t i = 0; i < all.size(); ++i)
    for (size_t j = i; j < all.size(); ++j)
      if (polyhedron(all[i]) && polyhedron(all[j]))
        set(r, all[i].type, all[j].type, collide_polyhedra);
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
  const auto type = [&](const Shape& s) {
    return size_t(query.by_triangles && s.field() ? ShapeType::triangle_mesh : s.type());
  };
  const Route& route = routes[type(a)][type(b)];
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
