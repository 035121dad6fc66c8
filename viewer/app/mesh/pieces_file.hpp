#pragma once
#include "engine/geometry/decomposition/convex_decomposition.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// How the names of files end that write_pieces() can write.
std::vector<std::string> piece_file_endings();

/// Every piece as an object of its own, whole or not at all: of an OBJ file (.obj) a group whose
/// faces are polygons, of a glTF file (.glb, or .gltf with its numbers inside) a node whose mesh is
/// triangles. glTF holds positions as floats, so that they are right to a 16-millionth of
/// themselves.
Status write_pieces(const std::filesystem::path& file, const ConvexDecomposition& pieces);

/// The same of a mesh, whose faces are triangles.
Status write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace tumble
