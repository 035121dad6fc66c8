#pragma once
#include "engine/scene/mesh_files/polygon_file.hpp"

#include <string_view>

namespace tumble {

/// A supported format of mesh files.
struct MeshFormat {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< lower case, without the dot
  Result<PolygonFile> (*read)(const std::filesystem::path&);
};

/// All supported formats. The library behind read_with_assimp has readers for more, which crash or
/// hang on damaged files and are therefore not used.
const std::vector<MeshFormat>& all_mesh_formats();

/// The format of a file by its extension; the error lists the supported ones.
Result<const MeshFormat*> mesh_format_of(const std::filesystem::path& file);

}  // namespace tumble
