#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/hierarchy/triangle_decisions.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace tumble {

/// What may keep a mesh from being the surface of a solid, in the order in which it is reported.
enum class SolidFaultKind : uint8_t {
  // These leave volume and mass undefined, or wrong.
  invalid,            ///< no triangles, a value that is not finite, an index out of range
  non_manifold_edge,  ///< edges with more than two triangles
  open_border,        ///< edges with one triangle
  misoriented,        ///< neighbours that run along their edge the same way
  one_sided,          ///< like a Moebius strip: no orientation agrees everywhere
  no_volume,          ///< nothing is enclosed
  inside_out,         ///< a closed shell whose normals point inwards
  self_intersection,  ///< triangles that pass through each other or lie upon each other
  counted_twice,      ///< a shell within another one that does not face the other way
  // These do not, but are worth knowing.
  non_manifold_vertex,  ///< surfaces that meet in a single vertex
  needle_fold,          ///< a triangle of nearly no height that lies back upon its neighbour
  degenerate_triangle,  ///< without area
  duplicate_triangle,   ///< with the same three corners as another one
  touching,             ///< triangles that are no neighbours and touch without crossing
};

/// "open_border" and so on.
std::string_view to_string(SolidFaultKind kind);

/// One kind of fault with everything that shows it. All numbers are those of the mesh as given.
struct SolidFault {
  SolidFaultKind kind = SolidFaultKind::invalid;
  bool blocks_mass = true;  ///< the mesh has no mass properties of its own
  size_t count = 0;         ///< edges, vertices, triangles, pairs or shells, as the kind says
  std::vector<std::array<uint32_t, 2>> edges;  ///< pairs of vertices, ascending
  std::vector<uint32_t> vertices;
  std::vector<uint32_t> triangles;
  std::vector<TriangleIds> pairs;            ///< of triangles, a < b
  std::vector<std::vector<uint32_t>> loops;  ///< vertices around each hole
  std::string text;  ///< what is wrong, with the first few items: "3 open edges (vertices 4-6 ...)"
  std::string cure;  ///< what to do about it
};

/// Triangles connected over edges.
struct SolidShell {
  uint32_t first_triangle = no_index;
  size_t triangles = 0;
  bool closed = false;  ///< every edge has two triangles, which run along it in opposite ways
  double volume = 0;    ///< signed [m^3]; only when closed
  uint32_t depth = 0;   ///< how many other shells are around it
  bool cavity() const { return closed && volume < 0 && depth % 2 == 1; }
};

/// Whether a mesh is the surface of a solid, and everything that speaks against it.
struct SolidReport {
  std::vector<SolidFault> faults;  ///< at most one of a kind, in the order of SolidFaultKind
  std::vector<SolidShell> shells;  ///< in order of first triangle
  size_t cavities = 0;             ///< shells that bound a hollow
  bool intersections_checked = false;

  /// No fault that leaves mass undefined.
  bool solid() const;
  /// The fault of a kind, or null.
  const SolidFault* find(SolidFaultKind kind) const;
  /// The first fault that leaves mass undefined as an Error with its cure; the message names the
  /// kinds of the others.
  Status status() const;
  /// A line per fault, each with its cure; empty when there is nothing to say.
  std::string text() const;
};

struct SolidOptions {
  bool self_intersections = true;  ///< the only check that takes more than a sort
};

/// Looks for every fault of a mesh, which may be any mesh at all.
///
/// Neighbourhood is by vertex number: weld first. Intersection is decided exactly for the doubles
/// given (triangle_relation), by the positions of corners: triangles that share corners or a side
/// intersect when they have more than those in common; two that share a side do when one is folded
/// onto the other. Shells that only touch each other are no fault of mass: that they do not lie
/// within each other is checked by exact winding numbers, as is the nesting of shells.
SolidReport check_solid(const TriangleMesh& mesh, const SolidOptions& options = {});

}  // namespace tumble
