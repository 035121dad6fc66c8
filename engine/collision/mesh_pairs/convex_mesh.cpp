#include "engine/collision/mesh_pairs/convex_mesh.hpp"

#include "engine/collision/convex_pairs/convex_convex.hpp"
#include "engine/collision/convex_pairs/face_clipping.hpp"
#include "engine/collision/feature_key.hpp"
#include "engine/collision/mesh_pairs/feature_contacts.hpp"
#include "engine/collision/shapes/polyhedral.hpp"
#include "engine/collision/triangle_core.hpp"
#include "engine/core/stop.hpp"
#include "engine/core/work_meter.hpp"
#include "engine/geometry/constructions/closest_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Cosine above which a direction counts as the face's own normal.
constexpr double along_face = 1 - 5e-9;
/// Sine of the angle by which a direction may leave the normals of a side or corner.
constexpr double wedge = 0.02;

/// One convex core (A) against the triangles of a mesh (B), query frame. `out` below is a unit
/// direction out of the mesh; the normals of contacts, from A to B, are opposite. An open mesh has
/// its outer side where the core is.
struct Query {
  PlacedCore A;
  PlacedSurface B;
  double margin;
  std::vector<FeatureContact>& contacts;
  double side = 1;  ///< -1: the core is behind an open mesh

  Vec3 face_normal(uint32_t f) const { return side * B.face_normal(f); }
  /// Whether the surface is convex there, or ends.
  bool active(const MeshEdge& edge) const {
    return edge.bend == EdgeBend::open ||
           edge.bend == (side > 0 ? EdgeBend::convex : EdgeBend::concave);
  }
  bool active_vertex(uint32_t v) const {
    const auto edges = B.s.topology.edges_of_vertex(v);
    return std::any_of(edges.begin(), edges.end(),
                       [this](uint32_t e) { return active(B.s.topology.edges[e]); });
  }
};

struct TriangleView {
  uint32_t id;
  std::array<Vec3, 3> corner;  ///< query frame
  Vec3 normal;
};

TriangleView view(const Query& q, uint32_t t) {
  const Triangle& ids = q.B.s.mesh->triangles[t];
  return {t, {q.B.vertex(ids[0]), q.B.vertex(ids[1]), q.B.vertex(ids[2])}, q.face_normal(t)};
}

/// The side of an open mesh that the core's centre is on, by the nearest feature.
double side_of(const Query& q, std::span<const uint32_t> triangles) {
  if (q.B.s.closed) return 1;
  const Vec3 p = q.B.R.transpose() * (q.A.centre() - q.B.x);
  const auto behind = [&](uint32_t t) {
    return q.B.s.topology.face_normals[t].dot(p - q.B.s.mesh->corner(t, 0)) < 0;
  };
  if (std::none_of(triangles.begin(), triangles.end(), behind)) return 1;
  constexpr double far = std::numeric_limits<double>::infinity();
  return nearest_feature(q.B.s, p, triangles, far).inside ? -1 : 1;
}

/// Whether `out` lies between the normals of the faces at an edge.
bool edge_faces(const PlacedSurface& B, const MeshEdge& edge, const Vec3& out) {
  const Vec3 p = B.vertex(edge.vertices[0]);
  const Vec3 u = (B.vertex(edge.vertices[1]) - p).normalized();
  for (uint32_t f : edge.faces) {
    if (f == no_index) continue;
    Vec3 into = B.face_normal(f).cross(u);
    for (uint32_t v : B.s.mesh->triangles[f])
      if (v != edge.vertices[0] && v != edge.vertices[1] && into.dot(B.vertex(v) - p) < 0)
        into = -into;
    if (out.dot(into) > wedge) return false;
  }
  return true;
}

/// Whether no edge of the vertex extends further along `out` than the vertex.
bool vertex_faces(const PlacedSurface& B, uint32_t v, const Vec3& out) {
  const Vec3 p = B.vertex(v);
  for (uint32_t e : B.s.topology.edges_of_vertex(v)) {
    const auto& ends = B.s.topology.edges[e].vertices;
    const Vec3 along = B.vertex(ends[0] == v ? ends[1] : ends[0]) - p;
    if (out.dot(along) > wedge * along.norm()) return false;
  }
  return true;
}

/// Adds the points of the clipped faces of the core and of a feature of the mesh; the nearest
/// points themselves if none of those is as near.
void add_points(const Query& q, const SupportingFace& feature, const Vec3& out, const Vec3& on_a,
                const Vec3& on_b, double gap, uint64_t key) {
  SupportingFace face;
  q.A.supporting_face(-out, face);
  ManifoldBuilder points;
  const double r = q.A.core->rounding();
  clip_faces(face, feature, -out, r, 0, q.margin, points);
  double least = gap + 1.0;
  for (const ManifoldPoint& p : points.points()) {
    q.contacts.push_back({p.x_world, -out, p.gap, p.feature});
    least = std::min(least, p.gap);
  }
  if (least > gap + 1e-6 + 1e-3 * std::abs(gap))
    q.contacts.push_back({0.5 * (on_a - r * out + on_b), -out, gap, key});
}

SupportingFace face_of(const Query& q, const TriangleView& t) {
  SupportingFace f;
  // clockwise about the normal from A to B, as clip_faces wants it: counter-clockwise from outside
  for (size_t i = 0; i < 3; ++i) {
    const size_t k = q.side > 0 ? i : 2 - i;
    f.add(t.corner[k], q.B.s.mesh->triangles[t.id][k]);
  }
  return f;
}

/// The feature of a triangle that contains a point, which is on the triangle up to rounding.
TriangleFeature feature_at(const TriangleView& t, const Vec3& x) {
  const Vec3 w = closest_on_triangle(x, t.corner[0], t.corner[1], t.corner[2]).barycentric;
  constexpr double none = 1e-6;
  for (unsigned k = 0; k < 3; ++k) {
    if (w[k] >= none) continue;
    const unsigned i = (k + 1) % 3, j = (k + 2) % 3;  // the sides opposite to those corners
    if (w[i] < none) return TriangleFeature(j);
    if (w[j] < none) return TriangleFeature(i);
    return TriangleFeature(3 + i);
  }
  return TriangleFeature::face;
}

/// Contact of a core that is outside the triangle, at the feature of the triangle that has the
/// nearest point; the rounded shape may overlap it.
void shallow(const Query& q, const TriangleView& t, const CoreContact& c) {
  const Vec3 out = -c.normal;
  const TriangleFeature feature = feature_at(t, c.b);
  const MeshTopology& topology = q.B.s.topology;
  const double along = out.dot(t.normal);
  if (along > along_face) {
    const uint64_t key = feature_key(FeaturePair::closest, 0, 0);
    add_points(q, face_of(q, t), t.normal, c.a, c.b, c.gap, key);
    return;
  }
  if (feature == TriangleFeature::face) return;  // from behind
  const unsigned k = feature_index(feature);
  if (is_edge(feature)) {
    const uint32_t e = topology.face_edges[t.id][k];
    if (e == no_index || !q.active(topology.edges[e])) return;
    const MeshEdge& edge = topology.edges[e];
    if (q.side * q.B.direction(edge.normal).dot(out) <= 0 || !edge_faces(q.B, edge, out)) return;
    SupportingFace side;
    for (uint32_t v : edge.vertices) side.add(q.B.vertex(v), v);
    add_points(q, side, out, c.a, c.b, c.gap, feature_key(FeaturePair::edge_edge, 0, e));
    return;
  }
  const uint32_t v = q.B.s.mesh->triangles[t.id][k];
  if (!q.active_vertex(v) || q.side * q.B.direction(topology.vertex_normals[v]).dot(out) <= 0)
    return;
  if (!vertex_faces(q.B, v, out)) return;
  const double r = q.A.core->rounding();
  q.contacts.push_back(
      {0.5 * (c.a - r * out + c.b), c.normal, c.gap, feature_key(FeaturePair::face_vertex, 0, v)});
}

/// Contact of a core that intersects the triangle: out along the face's normal if the core's lowest
/// part projects into the triangle, otherwise along the shortest way out if it is valid for the
/// feature there.
void deep(const Query& q, const TriangleView& t, const CoreContact& c) {
  const double r = q.A.core->rounding();
  const Vec3 lowest = q.A.support(-t.normal);
  const double gap = t.normal.dot(lowest - t.corner[0]) - r;
  const double shortest = c.gap;
  const Vec3 out = -c.normal;
  const bool face_wins = gap >= 1.05 * shortest - 1e-9 || out.dot(t.normal) > along_face;
  if (!face_wins) {
    if (feature_at(t, c.b) != TriangleFeature::face && out.dot(t.normal) < along_face) {
      shallow(q, t, c);
      return;
    }
  }
  const float thickness = q.B.s.thickness[t.id];
  if (-gap > 0.5 * (double(thickness) + 2 * std::abs(t.normal.dot(q.A.centre() - lowest)) + r))
    return;
  SupportingFace face;
  q.A.supporting_face(-t.normal, face);
  ManifoldBuilder points;
  clip_faces(face, face_of(q, t), -t.normal, r, 0, q.margin, points);
  for (const ManifoldPoint& p : points.points())
    q.contacts.push_back({p.x_world, -t.normal, p.gap, p.feature});
  if (points.count() > 0) return;
  // a point-like core (ball, end of a capsule) or a corner over the triangle
  const Vec3 foot = lowest - (gap + r) * t.normal;
  const TrianglePoint under = closest_on_triangle(foot, t.corner[0], t.corner[1], t.corner[2]);
  if (under.feature != TriangleFeature::face) return;
  q.contacts.push_back(
      {foot + 0.5 * gap * t.normal, -t.normal, gap, feature_key(FeaturePair::vertex_face, 0, 0)});
}

/// Contacts for ends of a rounded core that are completely below the surface.
void sunk_ends(const Query& q, std::span<const uint32_t> triangles, double reach) {
  SupportingFace ends;
  q.A.supporting_face(Vec3::UnitY(), ends);
  const double r = q.A.core->rounding();
  for (int i = 0; i < ends.count; ++i) {
    const Vec3& x = ends.points[size_t(i)];
    const Vec3 p = q.B.R.transpose() * (x - q.B.x);
    const NearestFeature near = nearest_feature(q.B.s, p, triangles, reach);
    if (near.triangle == no_index || near.inside != (q.side > 0)) continue;
    if (near.distance > 0.5 * double(q.B.s.thickness[near.triangle]) + r) continue;
    const Vec3 way = near.distance > 1e-9 * q.B.s.size && !near.on_face
                         ? Vec3((near.point - p) / near.distance)
                         : Vec3(q.side * near.normal);
    const Vec3 out = q.B.direction(way);
    const double gap = -near.distance - r;
    q.contacts.push_back({x - (r + 0.5 * gap) * out, -out, gap,
                          feature_key(FeaturePair::vertex_face, ends.ids[size_t(i)], 1)});
  }
}

/// A triangle that the core intersects.
struct Entered {
  TriangleView triangle;
  CoreContact contact;
};

/// If no feature was valid though the core intersects the mesh (as deep across a ridge): out along
/// that of the available directions which clears all intersected triangles after the shortest way.
void clear_all(const Query& q, std::span<const Entered> entered) {
  Vec3 best = Vec3::Zero(), sum = Vec3::Zero(), x = Vec3::Zero();
  double least = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Vec3& out) {
    double top = -std::numeric_limits<double>::infinity();
    for (const Entered& e : entered)
      for (const Vec3& p : e.triangle.corner) top = std::max(top, out.dot(p));
    const double depth = top - out.dot(q.A.support(-out)) + q.A.core->rounding();
    if (depth < least) least = depth, best = out;
  };
  for (const Entered& e : entered) {
    const Vec3 out = -e.contact.normal;
    consider(e.triangle.normal);
    if (out.dot(e.triangle.normal) > 0) consider(out);
    sum += e.triangle.normal;
    x += 0.5 * (e.contact.a + e.contact.b) / double(entered.size());
  }
  if (sum.norm() > 1e-3) consider(sum.normalized());
  if (!(least > 0)) return;
  q.contacts.push_back({x, -best, -least, feature_key(FeaturePair::closest, 0, 1)});
}

/// Whether the core is wholly farther than the margin on one side of the triangle's plane.
bool beyond_plane(const Query& q, const TriangleView& t) {
  const double offset = t.normal.dot(t.corner[0]), r = q.A.core->rounding();
  return t.normal.dot(q.A.support(-t.normal)) - r > offset + q.margin ||
         t.normal.dot(q.A.support(t.normal)) + r < offset - q.margin;
}

}  // namespace

void collide_convex_mesh(const ShapePair& pair, std::vector<Manifold>& out) {
  thread_local std::vector<FeatureContact> contacts;
  thread_local std::vector<uint32_t> triangles;
  thread_local std::vector<Entered> entered;
  contacts.clear(), triangles.clear(), entered.clear();
  const ConvexShape& a = *pair.a.convex();
  const MeshSurface& b = pair.b.polyhedral()->surface();
  Query q{PlacedCore(a, pair.pose_a.q, pair.pose_a.x),
          {b, pair.pose_b.q.toRotationMatrix(), pair.pose_b.x},
          pair.margin,
          contacts};
  b.tree->overlap(a.bounds(pair.pose_b.inverse() * pair.pose_a).inflated(pair.margin), triangles);
  if (triangles.empty()) return;
  q.side = side_of(q, triangles);
  bool behind = false;
  for (uint32_t id : triangles) {
    charge_work(1500);
    if (stop_requested()) return;
    const TriangleView t = view(q, id);
    if (t.normal.isZero() || beyond_plane(q, t)) continue;
    const TriangleCore core(t.corner[0], t.corner[1], t.corner[2]);
    const CoreContact c =
        nearest_or_deepest(q.A, PlacedCore(core, Quat::Identity(), Vec3::Zero()), pair.margin);
    if (!c.within) continue;
    // nearer than this the direction between the nearest points is noise
    const bool touching = c.overlap || c.gap + a.rounding() < 1e-6 * a.bounding_radius();
    if (touching) {
      deep(q, t, c);
      entered.push_back({t, c});
    } else {
      shallow(q, t, c);
    }
    behind = behind || touching || c.normal.dot(t.normal) > 0;
  }
  if (behind && a.rounding() > 0) sunk_ends(q, triangles, 2 * a.bounding_radius());
  const auto pressed = [](const FeatureContact& c) { return c.gap <= 0; };
  if (!entered.empty() && std::none_of(contacts.begin(), contacts.end(), pressed))
    clear_all(q, entered);
  emit_patches(pair, contacts, out);
}

}  // namespace tumble
