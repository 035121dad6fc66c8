#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <functional>
#include <vector>

namespace tumble {

class Crew;

/// Must be changed whenever the same mesh and options may give other pieces than before: caches of
/// pieces are keyed by it.
inline constexpr uint32_t decomposition_version = 4;

/// Receives the progress of a decomposition: the numbers of pieces that are done, and of pieces
/// still to be cut.
using DecompositionProgress = std::function<void(size_t done, size_t waiting)>;

struct ExactDecompositionOptions {
  /// Reflex edges no deeper than this are not cut, and those within this distance of a cut are
  /// resolved by it [m]; 0: 1e-12 of the mesh's diagonal. Files with coordinates rounded to six
  /// digits have faces that are flat only to 1e-6, with reflex edges across them, which need a
  /// value here.
  double tolerance = 0;
  size_t max_pieces = 10000;  ///< more is an error
  DecompositionProgress progress = {};
};

struct ApproximateDecompositionOptions {
  /// No point of any piece is farther outside the solid than this, as sampled [m]; 0: a fiftieth of
  /// the mesh's diagonal.
  double concavity = 0;
  size_t max_pieces = 64;  ///< takes precedence: pieces are merged down to it
  Crew* crew = nullptr;    ///< the pieces are the same with any or none
  DecompositionProgress progress = {};
};

/// One convex piece.
struct ConvexPiece {
  ConvexPolyhedron hull;
  double volume = 0;  ///< of the hull [m^3]
  double solid = 0;   ///< of the part of the mesh that it covers [m^3]
  double added = 0;   ///< how far it extends beyond the mesh, as sampled; 0 in exact mode [m]
};

struct ConvexDecomposition {
  std::vector<ConvexPiece> pieces;
  bool exact = false;
  double mesh_volume = 0;   ///< [m^3]
  double solid_volume = 0;  ///< sum over the parts that pieces cover [m^3]
  double hull_volume = 0;   ///< sum over the pieces [m^3]
  /// In exact mode: number of parts as thin as rounding, which are left out, and their volume
  /// [m^3].
  size_t left_out = 0;
  double left_out_volume = 0;
  /// Hausdorff distance of mesh and pieces in both directions, as sampled [m]: how far pieces
  /// extend beyond the mesh, and how far parts of the mesh are from all pieces.
  double added = 0, missing = 0;
  double concavity = 0;   ///< the bound that was given [m]
  bool bound_met = true;  ///< false if max_pieces made the bound impossible
  size_t cuts = 0;
};

/// Exact convex decomposition of a closed polyhedron (Coutinho 2013 §11 after Joe, "Tetrahedral
/// mesh generation in polyhedral regions based on convex polyhedron decompositions", 1994;
/// Chazelle, "Convex partitions of polyhedra", 1984): solids are cut by planes through reflex
/// edges, with few planes by a greedy choice (cut_planes.hpp), until no reflex edge is left. Each
/// cut removes the notches on it and creates none, so that it terminates. Corners of pieces are
/// intersections of three planes, and every decision is made in exact arithmetic (exact_space.hpp):
/// pieces do not overlap, and their volumes add up to that of the mesh. Coordinates are rounded
/// once, at the end; pieces as thin as a few rounding errors are then left out and counted. Errors:
/// the mesh is not a solid (SolidReport::status()); options out of range; more than max_pieces;
/// cancelled.
Result<ConvexDecomposition> decompose_exactly(const TriangleMesh& mesh,
                                              const ExactDecompositionOptions& options = {});

/// Approximate convex decomposition for collision: solids are cut where that reduces the volumes of
/// the hulls of both sides most, until no hull extends beyond the mesh by more than `concavity`.
/// Then neighbours are merged if their hull is within that distance of the solids that it covers,
/// so that hulls do not overlap more deeply; if more than `max_pieces` are left, also if it is
/// within that distance of the mesh. All of the mesh stays covered, except for layers of a 250th of
/// `concavity` that cuts through curved faces leave. Errors: as for the exact one; concavity or
/// max_pieces out of range.
Result<ConvexDecomposition> decompose_approximately(
    const Hierarchy& surface, const ApproximateDecompositionOptions& options = {});

/// How far hulls extend beyond a mesh, and its surface beyond them, at `samples` points each
/// (Halton 1960) [m].
struct HullError {
  double added = 0, missing = 0;
};
HullError measure_hulls(const std::vector<ConvexPiece>& pieces, const Hierarchy& surface,
                        size_t samples);

}  // namespace tumble
