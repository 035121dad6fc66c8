#pragma once
#include "engine/core/result.hpp"
#include "engine/geometry/mesh_cleanup.hpp"
#include "engine/geometry/triangle_mesh.hpp"
#include "engine/scene/description/shape.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tumble {

struct ImportOptions {
  double scale = 1;       ///< metres per unit of the file
  Vec3 stretch{1, 1, 1};  ///< further factors along x, y, z after turning
  UpAxis up = UpAxis::y;  ///< axis of the file that points up
  bool centre = false;    ///< move the middle of the bounds to the origin
  /// Vertices this near are one, and corners this near to a side lie on it [m]; 1e-9 of the largest
  /// extent unless given, at most a hundredth of it.
  std::optional<double> weld{};
};

/// A mesh of the file, as a node of it placed it.
struct ImportedPart {
  std::string name;
  size_t triangles = 0;
};

struct ImportedMesh {
  TriangleMesh mesh;
  std::vector<ImportedPart> parts;
  CleanupReport cleanup;           ///< of the joined mesh, after each part was welded
  std::vector<std::string> notes;  ///< what was changed: welded, dropped, turned over
};

/// Reads a mesh file (OBJ, STL, PLY, OFF, glTF, DAE and others: all_mesh_formats()), applies the
/// transforms of its nodes, cuts polygons into triangles, welds near vertices within each part and
/// between parts that are open, splits triangles at T-junctions, drops those without area, makes
/// neighbours agree in orientation and turns closed surfaces right side out. Errors: missing,
/// empty, unreadable or unknown file, no triangles, values that are not finite, too large.
Result<ImportedMesh> import_mesh(const std::filesystem::path& file,
                                 const ImportOptions& options = {});

}  // namespace tumble
