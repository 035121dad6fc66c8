#pragma once
#include "engine/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// A scene that can be opened by name.
struct CatalogueEntry {
  std::string name;         ///< file name without ".json"
  std::string title;        ///< the name, if the file gives no title or cannot be read
  std::string description;  ///< one line
  std::string category;     ///< heading in lists; may be empty
  std::filesystem::path file;
};

/// Every scenes/*.json and scenes/lessons/*.json of the resource roots, by name; of equal names
/// that of the first root.
std::vector<CatalogueEntry> scene_catalogue();

/// The file meant by a path or the name of a scene of the catalogue; of a pack the scene in it,
/// unpacked. Errors: neither (with a scene
/// of nearly that name), a folder.
Result<std::filesystem::path> resolve_scene(const std::string& name_or_path);

/// Reads a file: a scene; a mesh, as the scene in which it falls on a table (drop_in_scene); or a
/// robot, as the scene around it (robot_scene).
SceneRead read_scene_file(const std::filesystem::path& file, const ReadOptions& options = {});

/// Whether a file that is not a robot's is opened as a mesh: it has an extension other than .json
/// and .jsonc.
bool is_mesh_file(const std::filesystem::path& file);

/// Opens a scene by name or path, or another file as read_scene_file() does. A missing file is a
/// fault.
SceneRead open_scene(const std::string& name_or_path, const ReadOptions& options = {});

}  // namespace tumble
