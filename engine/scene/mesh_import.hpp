#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "engine/scene/description/shape.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

struct ImportOptions {
  double scale = 1;       ///< metres per unit of the file
  Vec3 stretch{1, 1, 1};  ///< further factors along x, y, z after turning
  UpAxis up = UpAxis::y;  ///< axis of the file that points up
  bool centre = false;    ///< move the middle of the bounds to the origin
};

struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<std::string> notes;  ///< what was changed: welded, dropped, turned over
};

/// Reads a mesh file through assimp (OBJ, STL, PLY, OFF, glTF, DAE and many more), joins all its
/// parts, welds equal vertices, drops triangles without area, and turns a closed surface right side
/// out. Errors: missing or unreadable file, no triangles, values that are not finite, too large.
Result<ImportedMesh> import_mesh(const std::filesystem::path& file,
                                 const ImportOptions& options = {});

}  // namespace tumble
