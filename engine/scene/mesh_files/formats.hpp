#pragma once
#include "engine/scene/mesh_files/polygon_file.hpp"

#include <string_view>

namespace tumble {

/// A kind of mesh file that is read.
struct MeshFormat {
  std::string_view name;
  std::vector<std::string_view> extensions;  ///< lower case, without the dot
  Result<PolygonFile> (*read)(const std::filesystem::path&);
};

/// Every format that is read. The library behind read_with_assimp knows more, whose readers crash
/// or hang on damaged files; those are left out on purpose.
const std::vector<MeshFormat>& all_mesh_formats();

/// The format of a file by its extension; the error lists those there are.
Result<const MeshFormat*> mesh_format_of(const std::filesystem::path& file);

}  // namespace tumble
