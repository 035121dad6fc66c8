#pragma once
#include "engine/geometry/decomposition/convex_decomposition.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// Endings of file names that write_pieces() supports.
std::vector<std::string> piece_file_endings();

/// Writes every piece as an object of its own, whole or not at all: in an OBJ file (.obj) a group
/// whose faces are polygons, in a glTF file (.glb, or .gltf with embedded data) a node whose mesh
/// is triangles. glTF stores positions in single precision, i.e. with a relative error up to 2^-24.
Status write_pieces(const std::filesystem::path& file, const ConvexDecomposition& pieces);

/// The same of a mesh, whose faces are triangles.
Status write_mesh(const std::filesystem::path& file, const TriangleMesh& mesh);

}  // namespace tumble
