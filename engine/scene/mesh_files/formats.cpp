#include "engine/scene/mesh_files/formats.hpp"

#include <algorithm>
#include <cctype>

#include <fmt/format.h>

namespace tumble {

const std::vector<MeshFormat>& all_mesh_formats() {
  static const std::vector<MeshFormat> formats = {
      {"3D Studio", {"3ds"}, read_with_assimp},
      {"AC3D", {"ac", "acc"}, read_with_assimp},
      {"AMF", {"amf"}, read_with_assimp},
      {"Blitz3D", {"b3d"}, read_with_assimp},
      {"Collada", {"dae"}, read_collada},
      {"FBX", {"fbx"}, read_with_assimp},
      {"glTF", {"gltf", "glb"}, read_gltf},
      {"MilkShape", {"ms3d"}, read_with_assimp},
      {"OBJ", {"obj"}, read_obj},
      {"OFF", {"off"}, read_off},
      {"PLY", {"ply"}, read_ply},
      {"Quake II", {"md2"}, read_with_assimp},
      {"STL", {"stl"}, read_stl},
      {"X3D", {"x3d"}, read_with_assimp},
  };
  return formats;
}

Result<const MeshFormat*> mesh_format_of(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  std::string known;
  for (const MeshFormat& f : all_mesh_formats()) {
    for (const std::string_view e : f.extensions) {
      if (e == extension) return &f;
      known += fmt::format("{}{}", known.empty() ? "" : " ", e);
    }
  }
  return Error{ErrorCode::unsupported,
               extension.empty() ? std::string("a mesh file without extension")
                                 : fmt::format("mesh files of type '{}' are not read", extension),
               file.string(), "convert it to one of: " + known};
}

}  // namespace tumble
