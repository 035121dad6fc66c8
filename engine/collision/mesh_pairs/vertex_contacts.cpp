#include "engine/collision/feature_key.hpp"
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Sine of the angle by which edges around a vertex may reach past it towards the other surface.
constexpr double cone_in_front = 0.3;

/// Whether no edge of the vertex extends further than the tolerance along -n, where n (unit, query
/// frame) points out of the surface that the vertex touches.
bool sticks_out(const PlacedSurface& V, uint32_t vertex, const Vec3& n, double sine) {
  const Vec3 n_local = V.local_direction(n);
  const Vec3& p = V.s.vertex(vertex);
  for (uint32_t e : V.s.topology.edges_of_vertex(vertex)) {
    const auto& ends = V.s.topology.edges[e].vertices;
    const Vec3 along = V.s.vertex(ends[0] == vertex ? ends[1] : ends[0]) - p;
    if (along.dot(n_local) < -sine * along.norm()) return false;
  }
  return true;
}

/// Pseudo-normal of a feature of a triangle, own frame.
const Vec3& feature_normal(const MeshSurface& s, uint32_t triangle, TriangleFeature feature) {
  const unsigned k = feature_index(feature);
  if (is_vertex(feature)) return s.topology.vertex_normals[s.mesh->triangles[triangle][k]];
  if (is_edge(feature)) {
    const uint32_t e = s.topology.face_edges[triangle][k];
    if (e != no_index) return s.topology.edges[e].normal;
  }
  return s.topology.face_normals[triangle];
}

/// Updates the nearest point by that of one triangle.
void consider(NearestFeature& nearest, TriangleFeature& feature, uint32_t t,
              const TrianglePoint& c) {
  const double distance = std::sqrt(c.squared_distance);
  if (distance >= nearest.distance) return;
  nearest.distance = distance;
  nearest.triangle = t;
  nearest.point = c.point;
  feature = c.feature;
}

void decide_side(NearestFeature& nearest, TriangleFeature feature, const MeshSurface& s,
                 const Vec3& p) {
  if (nearest.triangle == no_index) return;
  nearest.on_face = feature == TriangleFeature::face;
  nearest.normal = feature_normal(s, nearest.triangle, feature);
  nearest.inside = nearest.normal.dot(p - nearest.point) < 0;
  const unsigned k = feature_index(feature);
  if (is_edge(feature)) {
    const uint32_t e = s.topology.face_edges[nearest.triangle][k];
    nearest.sharp = e != no_index && s.edge_active[e];
  } else if (is_vertex(feature)) {
    nearest.sharp = s.vertex_active[s.mesh->triangles[nearest.triangle][k]];
  }
}

/// Distance of a point from the box of a triangle along the axis where it is greatest; negative
/// inside.
double beyond_box(const MeshSurface& s, uint32_t t, const Vec3& p) {
  const Vec3 &a = s.mesh->corner(t, 0), &b = s.mesh->corner(t, 1), &c = s.mesh->corner(t, 2);
  return std::max((a.cwiseMin(b).cwiseMin(c) - p).maxCoeff(),
                  (p - a.cwiseMax(b).cwiseMax(c)).maxCoeff());
}

TrianglePoint closest(const MeshSurface& s, uint32_t t, const Vec3& p) {
  return closest_on_triangle(p, s.mesh->corner(t, 0), s.mesh->corner(t, 1), s.mesh->corner(t, 2));
}

/// Contact of a vertex outside F whose nearest point is on a ridge or corner, not in the interior
/// of a face.
void beside_contact(const PlacedSurface& V, uint32_t vertex, const PlacedSurface& F,
                    const NearestFeature& nearest, double margin, const Vec3& world,
                    std::vector<FeatureContact>& contacts) {
  if (nearest.on_face || !nearest.sharp) return;
  const double distance = nearest.distance;
  if (distance > margin || distance < 1e-9 * F.s.size) return;
  const Vec3 out = (world - F.point(nearest.point)) / distance;
  if (!sticks_out(V, vertex, out, cone_in_front)) return;
  contacts.push_back({world - 0.5 * distance * out, out, distance,
                      feature_key(FeaturePair::vertex_face, vertex, 0)});
}

/// Result of testing a vertex against the faces around it: the nearest feature, and the nearest
/// face that it is behind; contacts in front are added directly.
struct Around {
  NearestFeature nearest;
  double behind = 0;  ///< depth below the nearest face whose normal opposes the vertex [m]
  uint32_t behind_face = no_index;
};

}  // namespace

NearestFeature nearest_feature(const MeshSurface& s, const Vec3& p,
                               std::span<const uint32_t> triangles, double look) {
  NearestFeature nearest;
  TriangleFeature feature = TriangleFeature::face;
  for (uint32_t t : triangles) {
    const double height = s.topology.face_normals[t].dot(p - s.mesh->corner(t, 0));
    if (std::abs(height) <= std::min(look, nearest.distance))
      consider(nearest, feature, t, closest(s, t, p));
  }
  decide_side(nearest, feature, s, p);
  return nearest;
}

void vertex_contacts(const PlacedSurface& V, uint32_t vertex, const PlacedSurface& F,
                     std::span<const uint32_t> triangles, const ContactRange& range,
                     std::vector<FeatureContact>& contacts, std::vector<SunkVertex>& sunk) {
  const Vec3 world = V.vertex(vertex);
  const Vec3 p = F.R.transpose() * (world - F.x);  // everything below is in F's frame
  const double look = std::max(range.margin, range.reach);
  const uint64_t key = feature_key(FeaturePair::vertex_face, vertex, 0);
  Around around;
  around.behind = range.reach;
  TriangleFeature feature = TriangleFeature::face;
  for (uint32_t t : triangles) {
    const Vec3& n = F.s.topology.face_normals[t];
    const double height = n.dot(p - F.s.mesh->corner(t, 0)), h2 = height * height;
    if (std::abs(height) > look || n.isZero() || beyond_box(F.s, t, p) > look) continue;
    const TrianglePoint c = closest(F.s, t, p);
    consider(around.nearest, feature, t, c);
    const bool over = c.squared_distance <= h2 * (1 + 1e-9) + 1e-24 * F.s.size * F.s.size;
    if (!over) continue;
    const Vec3 out = F.direction(n);
    if (height >= 0) {
      if (height <= range.margin && sticks_out(V, vertex, out, cone_in_front))
        contacts.push_back({world - 0.5 * height * out, out, height, key});
    } else if (-height < around.behind && sticks_out(V, vertex, out, range.cone)) {
      around.behind = -height;
      around.behind_face = t;
    }
  }
  decide_side(around.nearest, feature, F.s, p);
  const NearestFeature& nearest = around.nearest;
  if (nearest.triangle == no_index) return;
  if (!nearest.inside) beside_contact(V, vertex, F, nearest, range.margin, world, contacts);
  Vec3 out = nearest.normal;
  double depth = nearest.distance;
  uint32_t face = nearest.triangle;
  bool found = nearest.inside && depth <= range.reach;
  if (found && !nearest.on_face && depth > 1e-9 * F.s.size) out = (nearest.point - p) / depth;
  found = found && sticks_out(V, vertex, F.direction(out), range.cone);
  if (found) sunk.push_back({vertex, depth, F.direction(out)});
  bool through_wall = false;
  if (!found) {
    if (around.behind_face == no_index) return;
    face = around.behind_face;
    out = F.s.topology.face_normals[face];
    // Through a thin wall: the vertex is nearest to the other side of it.
    through_wall = nearest.normal.dot(out) < 0;
    if (!through_wall && !(nearest.inside && around.behind <= 2 * depth)) return;
    depth = around.behind;
  }
  const Vec3 n = F.direction(out);
  const double wall = F.s.thickness_along({&face, 1}, out);
  const double body =
      V.s.thickness_along(V.s.topology.faces_of_vertex(vertex), V.local_direction(n));
  if (depth > 0.5 * (wall + body)) return;
  if (through_wall && wall > 0.25 * body) return;
  contacts.push_back({world + 0.5 * depth * n, n, -depth, key});
}

}  // namespace tumble
