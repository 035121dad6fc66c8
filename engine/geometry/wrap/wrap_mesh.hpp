#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/triangle_mesh.hpp"

#include <cstddef>
#include <cstdint>

namespace tumble {

class Crew;
class Hierarchy;

/// Changes whenever the same mesh and options may give another wrap than before: what is kept of
/// wraps is kept by it.
inline constexpr uint32_t wrap_version = 1;

struct WrapOptions {
  /// Holes and slits that a ball of this diameter does not pass are closed [m]; 0: a 12th of the
  /// mesh's longest side.
  double gap = 0;
  /// How far the wrap stands off the mesh [m], at least 1.75 cells; 0: two cells.
  double offset = 0;
  /// Side of a cell [m]; 0: half of `offset`, or, when that is 0 too, a quarter of the gap, but
  /// from a 128th to a 40th of the mesh's longest side.
  double cell = 0;
  size_t max_bytes = size_t{1} << 30;  ///< of the grid; more is an error
  /// Of the wrap, and of the surface about the mesh that it is measured from; more is an error.
  size_t max_triangles = MeshLimits{}.max_triangles;
  Crew* crew = nullptr;  ///< the wrap is the same, bit by bit, with any or none
};

/// What is taken where nothing is given, of a mesh with these bounds; options that are out of range
/// stay so.
WrapOptions complete(WrapOptions options, const Aabb& bounds);

/// How a wrap lies about its mesh. Distances are sampled at corners and evenly over the surfaces.
struct WrapReport {
  double gap = 0;      ///< what a ball of this diameter does not pass is closed [m]
  double offset = 0;   ///< [m]
  double cell = 0;     ///< [m]
  double added = 0;    ///< how far the wrap's surface is from the mesh at most [m]
  double missing = 0;  ///< how far the mesh stands out of the wrap: 0, as it is made [m]
  double buried = 0;   ///< how far the mesh lies beneath the wrap's surface at most [m]
  double bound = 0;    ///< `added` is no more, proven [m]
};

struct WrappedMesh {
  TriangleMesh mesh;
  WrapReport report;
};

/// A closed, oriented 2-manifold about any mesh at all, be it open, torn, inside out or a heap of
/// triangles that pass through each other. After "Alpha wrapping with an offset" (Portaneri et al.
/// 2022) in what it promises, by a grid in how it is made: the outside O is where a ball of
/// diameter `gap` (of twice the offset where that is more) gets to from far away without touching
/// the mesh, and the wrap encloses all that is no nearer to O than the ball's radius less the
/// offset: the morphological closing of the mesh (Serra, "Image Analysis and Mathematical
/// Morphology", 1982), thickened by the offset. So a sheet becomes a shell of twice the offset,
/// wide openings stay open, and hollows that have none are filled.
///
/// Both distances, from the mesh and from the boundary of O, are exact at the nodes and linear in
/// tetrahedra between them. As distances change by no more than one goes and tetrahedra have a
/// circumradius of sqrt(3)/2 cells, each is off by no more than that, and with an offset of more
/// than sqrt(3) cells all of the mesh lies inside, for certain.
///
/// Errors: the mesh is invalid or a point; options out of range; the grid would be too large, or
/// the wrap have too many triangles (the cure names a cell that fits); cancelled
/// (engine/core/stop.hpp).
Result<WrappedMesh> wrap_mesh(const Hierarchy& surface, const WrapOptions& options = {});

/// Measures how a closed mesh lies about another.
WrapReport measure_wrap(const Hierarchy& wrap, const Hierarchy& mesh);

}  // namespace tumble
