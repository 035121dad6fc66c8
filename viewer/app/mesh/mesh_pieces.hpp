#pragma once
#include "engine/geometry/decomposition/convex_decomposition.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace tumble {

class StopSignal;

/// Options of `tumble mesh --decompose`.
struct PiecesRequest {
  bool exact = false;
  double tolerance = 0;  ///< for exact pieces; 0: the default of decompose_exactly [m]
  double concavity = 0;  ///< for approximate ones; 0: the default of decompose_approximately [m]
  std::optional<size_t> most;  ///< greatest number of pieces; default: that of the decomposition
  std::string file;            ///< OBJ or glTF (pieces_file.hpp); empty: none is written
};

/// The pieces of a mesh and their cost.
struct PiecesFacts {
  ConvexDecomposition decomposition;
  double seconds = 0;
  std::filesystem::path file;
};

/// Decomposes with progress on stderr, or takes the pieces from the cache. Errors: those of the
/// decomposition; `cancelled` after a signal.
Result<PiecesFacts> decompose_mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                                   const PiecesRequest& request, const StopSignal& stop);

std::string pieces_text(const PiecesFacts& facts);

}  // namespace tumble
