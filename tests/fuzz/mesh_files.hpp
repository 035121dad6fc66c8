#pragma once
#include "engine/geometry/triangle_mesh.hpp"

#include <string>
#include <vector>

namespace tumble {

/// The bytes of a file, under a name whose ending says its format.
struct NamedFile {
  std::string name, bytes;
  bool text = true;  ///< false: numbers are binary
};

/// One mesh in every format and encoding that people hand over: OBJ, OFF, PLY and STL as text, PLY
/// (both orders of bytes), STL and GLB binary, glTF with its numbers in base64. Written here,
/// since the engine writes few of them.
std::vector<NamedFile> mesh_in_every_format(const TriangleMesh& mesh);

}  // namespace tumble
