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
inline constexpr uint32_t wrap_version = 3;

struct WrapOptions {
  /// Holes and slits that a ball of this diameter does not pass are closed [m]; 0: a 12th of the
  /// mesh's longest side.
  double gap = 0;
  /// How far the wrap stands off the mesh where it follows it [m], at least a millionth of the
  /// mesh's longest side; 0: a quarter of a cell.
  double offset = 0;
  /// Side of a cell [m], which is about the size of what the wrap can follow; 0: a quarter of the
  /// gap, but from a 128th to a 40th of the mesh's longest side.
  double cell = 0;
  /// By how much the wrap is off what a fine one would be, where that is more than a cell's area
  /// [m] (simplify_wrap.hpp); 0: a quarter of a cell.
  double tolerance = 0;
  size_t max_bytes = size_t{1} << 30;  ///< of the grid; more is an error
  /// Of the wrap before it is simplified; more is an error.
  size_t max_triangles = MeshLimits{}.max_triangles;
  Crew* crew = nullptr;  ///< the wrap is the same, bit by bit, with any or none
};

/// What is taken where nothing is given, of a mesh with these bounds; options that are out of range
/// stay so.
WrapOptions complete(WrapOptions options, const Aabb& bounds);

/// How a wrap lies about its mesh. Distances of the mesh from the wrap are sampled at corners and
/// evenly over its surface.
struct WrapReport {
  double gap = 0;      ///< what a ball of this diameter does not pass is closed [m]
  double offset = 0;   ///< [m]
  double cell = 0;     ///< [m]
  double added = 0;    ///< how far the wrap's surface is from the mesh at most [m]
  double missing = 0;  ///< how far the mesh stands out of the wrap: 0, as it is made [m]
  double buried = 0;   ///< how far the mesh lies beneath the wrap's surface at most [m]
  double nearest = 0;  ///< least distance of the two surfaces; 0 when they meet [m]
  double bound = 0;    ///< `added` is no more, proven [m]
};

struct WrappedMesh {
  TriangleMesh mesh;
  WrapReport report;
};

/// A closed, oriented 2-manifold without self-intersections about any mesh at all, be it open,
/// torn, inside out or a heap of triangles that pass through each other. After "Alpha wrapping with
/// an offset" (Portaneri et al. 2022) in what it promises, by a grid in how it is made:
///
/// 1. The outside O is where a ball of diameter `gap` gets to from far away without touching the
/// mesh, and the first surface encloses all that is no nearer to O than the ball's radius less the
/// first stand of offset + 1.75 cells: the morphological closing of the mesh (Serra, "Image
/// Analysis and Mathematical Morphology", 1982), thickened. Where the stand is more than half the
/// gap, the gap is twice the stand. So a sheet becomes a shell, wide openings stay open, and
/// hollows that have none are filled. All its nodes outside are at least the stand from the mesh,
/// so all of the mesh is inside, farther from the surface than the offset.
/// 2. That is drawn to the mesh (fit_wrap.hpp) and 3. simplified (simplify_wrap.hpp), by steps each
/// of which is tested to keep the mesh inside and half of the offset away.
///
/// Errors: the mesh is invalid or a point; options out of range; the grid would be too large, or
/// the first surface have too many triangles (the cure names a cell that fits); cancelled
/// (engine/core/stop.hpp).
Result<WrappedMesh> wrap_mesh(const Hierarchy& surface, const WrapOptions& options = {});

/// Measures how a closed mesh lies about another.
WrapReport measure_wrap(const Hierarchy& wrap, const Hierarchy& mesh);

}  // namespace tumble
