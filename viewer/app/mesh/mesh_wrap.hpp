#pragma once
#include "engine/geometry/wrap/wrap_mesh.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace tumble {

class StopSignal;

/// Options of `tumble mesh --wrap`; 0: the default.
struct WrapRequest {
  double gap = 0, offset = 0, cell = 0;  ///< of WrapOptions [m]
};

/// A wrap that replaces the mesh of a file.
struct WrapFacts {
  WrapReport report;
  size_t triangles = 0;        ///< of the mesh in the file
  double seconds = 0;          ///< time to compute it, or to read it from the cache [s]
  std::filesystem::path file;  ///< file it was written to; empty: none
};

/// Replaces a mesh by its wrap, computed with progress on stderr or taken from the cache. Errors:
/// those of wrap_mesh(); `cancelled` after a signal.
Result<WrapFacts> wrap_in_place(TriangleMesh& mesh, const WrapRequest& request,
                                const StopSignal& stop);

std::string wrap_text(const WrapFacts& facts);

}  // namespace tumble
