#pragma once
#include "engine/geometry/decomposition/convex_decomposition.hpp"
#include "engine/scene/build/content_cache.hpp"

namespace tumble {

/// The part of a convex decomposition that a scene needs.
struct MeshPieces {
  struct Piece {
    std::vector<Vec3> vertices;  ///< of its hull [m]
    double volume = 0;           ///< of the hull [m^3]
    double solid = 0;            ///< of the part of the mesh that it covers [m^3]
  };
  std::vector<Piece> pieces;
  /// How far the pieces extend beyond the mesh, and the mesh beyond them, as sampled [m].
  double added = 0, missing = 0;
  double concavity = 0;  ///< the bound [m]
  bool bound_met = true;
};

/// Cache of decompositions (content_cache.hpp).
class PieceCache {
 public:
  PieceCache() : PieceCache(ContentCache::usual_folder("decompositions")) {}
  explicit PieceCache(std::filesystem::path folder) : cache_(std::move(folder), ".pieces") {}

  const std::filesystem::path& folder() const { return cache_.folder(); }
  /// All of a decomposition: from the cache, or made and put there. Errors are those of
  /// decompose_approximately(), and of decompose_exactly().
  Result<ConvexDecomposition> decomposition(const std::shared_ptr<const TriangleMesh>& mesh,
                                            const ApproximateDecompositionOptions& options) const;
  Result<ConvexDecomposition> exact_decomposition(const TriangleMesh& mesh,
                                                  const ExactDecompositionOptions& options) const;
  /// The pieces of a mesh: from the cache, or made and put there. Errors are those of
  /// decompose_approximately().
  Result<MeshPieces> pieces(const std::shared_ptr<const TriangleMesh>& mesh,
                            const ApproximateDecompositionOptions& options) const;

 private:
  ContentCache cache_;
};

}  // namespace tumble
