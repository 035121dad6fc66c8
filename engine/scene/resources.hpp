#pragma once
#include "engine/core/result.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// Folders that hold scenes/, assets/ and shaders/, in the order in which they are searched: the
/// environment's TUMBLE_RESOURCE_DIR, share/tumble of the prefix that the program is installed in,
/// the source tree that it was built from. Only those that exist; never the working directory.
std::vector<std::filesystem::path> resource_roots();

/// A file or folder such as "scenes/tower.json" below the first root that has it.
Result<std::filesystem::path> find_resource(const std::filesystem::path& relative);

/// A mesh file of a scene: relative to the scene's folder, then assets/meshes of each root.
/// The error names where it was looked for and a file of nearly that name.
Result<std::filesystem::path> find_mesh_file(const std::filesystem::path& scene_folder,
                                             const std::string& file);

/// A user's own folder: that of an environment variable such as XDG_CACHE_HOME, else the one below
/// the home folder (XDG Base Directory Specification); empty where neither is known.
std::filesystem::path user_folder(const char* variable, const char* under_home);

}  // namespace tumble
