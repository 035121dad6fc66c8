#pragma once
#include "engine/geometry/decomposition/convex_decomposition.hpp"

#include <filesystem>

namespace tumble {

/// What a scene needs of a convex decomposition.
struct MeshPieces {
  struct Piece {
    std::vector<Vec3> vertices;  ///< of its hull [m]
    double volume = 0;           ///< of the hull [m^3]
    double solid = 0;            ///< of the part of the mesh that it stands for [m^3]
  };
  std::vector<Piece> pieces;
  double added = 0;      ///< how far they reach outside the mesh, as sampled [m]
  double concavity = 0;  ///< the bound [m]
  bool bound_met = true;
};

/// Decompositions that were made before, by the content of their meshes: a folder that several
/// processes may use at once. A file appears whole or not at all under the hash of everything that
/// decides what is in it, the version of the method too; one that is damaged, or another's, is made
/// anew. What cannot be read or written is as if there were no cache.
class PieceCache {
 public:
  /// tumble/decompositions under $XDG_CACHE_HOME, or ~/.cache (XDG Base Directory Specification);
  /// none where neither is known.
  PieceCache();
  explicit PieceCache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  const std::filesystem::path& folder() const { return folder_; }
  /// The pieces of a mesh: from the cache, or made and put there. Errors are those of
  /// decompose_approximately().
  Result<MeshPieces> pieces(const std::shared_ptr<const TriangleMesh>& mesh,
                            const ApproximateDecompositionOptions& options) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace tumble
