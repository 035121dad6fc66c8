#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/hierarchy/hierarchy.hpp"
#include "engine/geometry/hull/convex_polyhedron.hpp"

#include <functional>
#include <vector>

namespace tumble {

class Crew;

/// Changes whenever the same mesh and options may give other pieces than before: what is kept of
/// pieces is kept by it.
inline constexpr uint32_t decomposition_version = 4;

/// What is told of a decomposition while it goes on: pieces that are done, and pieces still to be
/// cut.
using DecompositionProgress = std::function<void(size_t done, size_t waiting)>;

struct ExactDecompositionOptions {
  /// Reflex edges no deeper than this are no reason to cut, and those as near to a cut are cut with
  /// it [m]; 0: 1e-12 of the mesh's diagonal. Files that round coordinates to six digits have faces
  /// that are flat to 1e-6 only, and reflex edges across them unless this says so.
  double tolerance = 0;
  size_t max_pieces = 10000;  ///< more is an error
  DecompositionProgress progress = {};
};

struct ApproximateDecompositionOptions {
  /// No point of any piece is farther from the solid than this, as sampled [m]; 0: a fiftieth of
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
  double solid = 0;   ///< of the part of the mesh that it stands for [m^3]
  double added = 0;   ///< how far it reaches outside the mesh, as sampled; 0 in exact mode [m]
};

struct ConvexDecomposition {
  std::vector<ConvexPiece> pieces;
  bool exact = false;
  double mesh_volume = 0;   ///< [m^3]
  double solid_volume = 0;  ///< of the parts that pieces stand for, summed [m^3]
  double hull_volume = 0;   ///< of the pieces, summed [m^3]
  /// Of exact pieces: parts as thin as rounding, which are no pieces, and their volume [m^3].
  size_t left_out = 0;
  double left_out_volume = 0;
  /// Two-sided Hausdorff distance of mesh and pieces, as sampled [m]: how far pieces reach outside
  /// the mesh, and how far parts of the mesh are from all pieces.
  double added = 0, missing = 0;
  double concavity = 0;   ///< the bound that was asked for [m]
  bool bound_met = true;  ///< false when max_pieces allowed no better
  size_t cuts = 0;
};

/// Exact convex decomposition of a closed polyhedron (Coutinho 2013 §11 after Joe, "Tetrahedral
/// mesh generation in polyhedral regions based on convex polyhedron decompositions", 1994;
/// Chazelle, "Convex partitions of polyhedra", 1984): solids are cut by planes through reflex
/// edges, as few of them as the choice of planes allows (cut_planes.hpp), until none is left. Each
/// cut takes the notches on it away and makes none, so it ends. Corners of pieces are where three
/// planes meet, and every decision is that of exact numbers (exact_space.hpp): pieces do not
/// overlap and their volumes add up to the mesh's. They are rounded once, at the end; what is as
/// thin as a few roundings is left out then, and counted. Errors: the mesh is no solid
/// (SolidReport::status()); options out of range; more than max_pieces; cancelled.
Result<ConvexDecomposition> decompose_exactly(const TriangleMesh& mesh,
                                              const ExactDecompositionOptions& options = {});

/// Approximate convex decomposition for collision: solids are cut where that takes most from the
/// volumes of the hulls of both sides, until no hull reaches farther outside the mesh than
/// `concavity`; then neighbours are merged while their hull stays that near to the solids that it
/// stands for, so that hulls lie in each other no deeper; with more than `max_pieces` left, while
/// it stays that near to the mesh. All of the mesh stays covered, but for skins of a 250th of
/// `concavity` that cuts through bent faces leave.
/// Errors: as of the exact one; concavity or max_pieces out of range.
Result<ConvexDecomposition> decompose_approximately(
    const Hierarchy& surface, const ApproximateDecompositionOptions& options = {});

/// How far hulls reach outside a mesh, and its surface outside them, at `samples` points each
/// (Halton 1960) [m].
struct HullError {
  double added = 0, missing = 0;
};
HullError measure_hulls(const std::vector<ConvexPiece>& pieces, const Hierarchy& surface,
                        size_t samples);

}  // namespace tumble
