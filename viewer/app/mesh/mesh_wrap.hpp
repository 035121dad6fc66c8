#pragma once
#include "engine/geometry/wrap/wrap_mesh.hpp"

#include <filesystem>
#include <memory>
#include <string>

namespace tumble {

class StopSignal;

/// What `tumble mesh --wrap` asks for; 0: the usual.
struct WrapRequest {
  double gap = 0, offset = 0, cell = 0;  ///< of WrapOptions [m]
};

/// A wrap that takes the place of the mesh of a file.
struct WrapFacts {
  WrapReport report;
  size_t triangles = 0;        ///< of the mesh of the file
  double seconds = 0;          ///< to make it, or to fetch it from the cache [s]
  std::filesystem::path file;  ///< that it was written into; empty: none
};

/// Puts the wrap of a mesh in its place, with progress on stderr, or from the cache. Errors: as
/// wrap_mesh() has them; `cancelled` after a signal.
Result<WrapFacts> wrap_in_place(TriangleMesh& mesh, const WrapRequest& request,
                                const StopSignal& stop);

std::string wrap_text(const WrapFacts& facts);

}  // namespace tumble
