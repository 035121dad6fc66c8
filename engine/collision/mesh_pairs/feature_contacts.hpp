#pragma once
#include "engine/collision/mesh_pairs/mesh_surface.hpp"
#include "engine/collision/mesh_pairs/patches.hpp"

#include <limits>
#include <optional>
#include <span>

namespace tumble {

/// A surface placed in the frame of a query.
struct PlacedSurface {
  const MeshSurface& s;
  Mat3 R;
  Vec3 x;

  Vec3 point(const Vec3& p) const { return x + R * p; }
  Vec3 vertex(uint32_t v) const { return point(s.vertex(v)); }
  Vec3 direction(const Vec3& d) const { return R * d; }
  Vec3 local_direction(const Vec3& d) const { return R.transpose() * d; }
  Vec3 face_normal(uint32_t f) const { return R * s.topology.face_normals[f]; }
};

/// An active vertex inside the other solid, with the direction of its shortest way out.
struct SunkVertex {
  uint32_t vertex;
  double depth;  ///< [m]
  Vec3 out;      ///< unit, query frame
};

/// Range of the search: gaps up to `margin` and depths up to `reach` [m]; `cone` is the sine of the
/// angle by which edges around a vertex inside may reach deeper than it.
struct ContactRange {
  double margin, reach, cone;
};

/// The nearest point of some triangles, and the side of the surface that the query point is on, by
/// the pseudo-normal of the nearest feature (Baerentzen & Aanaes 2005).
struct NearestFeature {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]
  uint32_t triangle = no_index;
  bool inside = false;
  bool on_face = false;  ///< in the interior of a triangle
  bool sharp = false;    ///< on an active side or corner
  Vec3 point, normal;    ///< nearest point and pseudo-normal there, frame of the surface
};
/// `p` is in the frame of the surface; triangles farther away than `look` may be missed.
NearestFeature nearest_feature(const MeshSurface& s, const Vec3& p,
                               std::span<const uint32_t> triangles, double look);

/// Adds the contacts of a vertex of V with those triangles of F that may be near. Normals in
/// `contacts` point out of F. A vertex in contact from inside F is added to `sunk`.
///
/// Outside F: every triangle over which the vertex lies, within the margin, if the surface of V
/// around the vertex does not reach much farther towards it. Inside, by the pseudo-normal of F's
/// nearest feature: that feature is the only contact; or, if the vertex has passed a thin wall, the
/// nearest face whose normal opposes the vertex.
void vertex_contacts(const PlacedSurface& V, uint32_t vertex, const PlacedSurface& F,
                     std::span<const uint32_t> triangles, const ContactRange& range,
                     std::vector<FeatureContact>& contacts, std::vector<SunkVertex>& sunk);

/// An edge in the frame of a query.
struct PlacedEdge {
  uint32_t id;
  Vec3 start, along;  ///< from its first vertex to its second [m]
  Vec3 normal;        ///< MeshEdge::normal

  PlacedEdge(const PlacedSurface& S, uint32_t edge) : id(edge) {
    const MeshEdge& e = S.s.topology.edges[edge];
    start = S.vertex(e.vertices[0]);
    along = S.vertex(e.vertices[1]) - start;
    normal = S.direction(e.normal);
  }
};

/// The nearest points of two edges, in the interior of both.
struct EdgeContact {
  Vec3 on_a, on_b;  ///< query frame
  Vec3 normal;      ///< unit, from A to B
  double gap;       ///< [m]
};
/// The contact of two active edges, if their common normal lies in the wedges of both.
std::optional<EdgeContact> edge_contact(const PlacedSurface& A, const PlacedEdge& a,
                                        const PlacedSurface& B, const PlacedEdge& b,
                                        const ContactRange& range);

/// Whether an edge of one triangle passes through the interior of the other.
bool triangles_cross(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b);

}  // namespace tumble
