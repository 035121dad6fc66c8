#pragma once
#include "engine/scene/reader.hpp"

#include <filesystem>

namespace tumble {

/// The scene for a bare mesh file: as the body "mesh" it falls, tilted, on a table. It is centred
/// and scaled so that its largest extent is half a metre, or as `--set parameters.size=2` says; an
/// open mesh gets the mass of its hull. Faults: the file cannot be read as a mesh.
SceneRead drop_in_scene(const std::filesystem::path& mesh_file, const ReadOptions& options = {});

}  // namespace tumble
