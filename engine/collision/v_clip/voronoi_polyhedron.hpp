#pragma once
#include "engine/collision/polyhedron_feature.hpp"
#include "engine/geometry/hull/convex_polyhedron.hpp"

namespace tumble {

/// An edge seen from one of its ends. Its direction is the normal of the vertex-edge Voronoi plane
/// through that end: the vertex's region is behind all planes of its spokes.
struct VoronoiSpoke {
  Vec3 direction;     ///< unit, away from the vertex
  double length = 0;  ///< of the edge [m]
  uint32_t edge = 0;
  uint32_t other = 0;  ///< the vertex at the far end
};

/// An edge with its four Voronoi planes: two vertex-edge planes perpendicular to it at its ends,
/// and two face-edge planes that contain it, with normals `into_face` in the planes of its faces.
/// The edge's region is between the first two and behind the others.
struct VoronoiEdge {
  Vec3 tail = Vec3::Zero();
  Vec3 direction = Vec3::Zero();  ///< unit, from vertices[0] (tail) to vertices[1] (head)
  double length = 0;              ///< [m]
  std::array<Vec3, 2> into_face;  ///< unit, in faces[k], away from the edge
  std::array<uint32_t, 2> vertices{};
  std::array<uint32_t, 2> faces{};
};

/// A face-edge plane seen from the face: points x of its region have inward.dot(x) >= offset.
struct VoronoiSide {
  Vec3 inward;
  double offset = 0;  ///< [m]
  uint32_t edge = 0;
};

struct VoronoiFace {
  Vec3 normal;        ///< unit, outward
  double offset = 0;  ///< [m]
  uint32_t first_side = 0, side_count = 0;
};

/// A convex polyhedron with the Voronoi planes of the space around it, computed once and stored in
/// flat arrays in the order in which V-Clip reads them. Features have the indices that they have in
/// the ConvexPolyhedron. All in its body frame.
struct VoronoiPolyhedron {
  std::vector<Vec3> vertices;
  std::vector<uint32_t> spoke_first;  ///< size vertices + 1
  std::vector<VoronoiSpoke> spokes;
  std::vector<VoronoiEdge> edges;
  std::vector<VoronoiFace> faces;
  std::vector<VoronoiSide> sides;  ///< face after face, counter-clockwise

  Vec3 centre = Vec3::Zero();  ///< mean of the vertices
  double radius = 0;           ///< of the ball about `centre` that contains it [m]
  double inner_radius = 0;     ///< of the ball about `centre` inside it [m]
  /// The greatest distance of a vertex from the plane of one of its faces [m]: the error of
  /// distances if facets were merged with a tolerance.
  double flatness = 0;
  /// The least sine of the obtuse corners of faces, that of the corner nearest to straight. It
  /// bounds how much greater than the slopes at a vertex a slope of the whole polyhedron can be.
  double least_corner_sine = 1;
  std::array<uint32_t, 8> octant_start{};  ///< a support vertex per octant, at which climbs begin

  std::span<const VoronoiSpoke> spokes_of(uint32_t v) const {
    return {spokes.data() + spoke_first[v], spoke_first[v + 1] - spoke_first[v]};
  }
  std::span<const VoronoiSide> sides_of(const VoronoiFace& f) const {
    return {sides.data() + f.first_side, f.side_count};
  }
  bool has(const PolyhedronFeature& f) const {
    const size_t count = f.kind == FeatureKind::vertex ? vertices.size()
                         : f.kind == FeatureKind::edge ? edges.size()
                         : f.kind == FeatureKind::face ? faces.size()
                                                       : 0;
    return f.index < count;
  }
};

/// Error if coordinates are not finite, an edge has no length, a face no plane, or two faces do not
/// meet convexly.
Result<VoronoiPolyhedron> make_voronoi_polyhedron(const ConvexPolyhedron& polyhedron);

/// A vertex extreme along `direction` (any length), up to rounding, found by climbing along edges
/// from the start vertex of the direction's octant.
uint32_t climb(const VoronoiPolyhedron& polyhedron, const Vec3& direction);

}  // namespace tumble
