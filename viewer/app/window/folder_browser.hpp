#pragma once
#include "viewer/ui/ui_state.hpp"

#include <filesystem>

namespace tumble {

/// The subfolders of a folder and the files that the window can open, sorted by name without regard
/// to case; hidden ones are left out.
FolderView look_through(const std::filesystem::path& folder);

/// Whether the window can open a file of this name: scenes, packs, robots, meshes.
bool can_be_opened(const std::filesystem::path& file);

}  // namespace tumble
