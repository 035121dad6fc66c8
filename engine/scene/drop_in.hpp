#pragma once
#include "engine/scene/reader.hpp"

#include <filesystem>

namespace tumble {

/// The scene for a bare mesh file: it falls, tilted, on a table. The mesh is scaled to `size` (a
/// parameter of the scene: `--set parameters.size=0.5`) and centred; `copies` fall one after the
/// other. Faults: the file cannot be read as a mesh.
SceneRead drop_in_scene(const std::filesystem::path& mesh_file, const ReadOptions& options = {});

}  // namespace tumble
