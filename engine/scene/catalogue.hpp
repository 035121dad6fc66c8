#pragma once
#include "engine/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// A scene that can be opened by name.
struct CatalogueEntry {
  std::string name;         ///< file name without ".json"
  std::string title;        ///< the name when the file gives none, or cannot be read
  std::string description;  ///< one line
  std::string category;     ///< under which lists show it; may be empty
  std::filesystem::path file;
};

/// Every scenes/*.json and scenes/lessons/*.json of the resource roots, by name; of equal names the
/// first root's.
std::vector<CatalogueEntry> scene_catalogue();

/// The file meant by a path or the name of a scene of the catalogue; of a pack the scene in it,
/// unpacked. Errors: neither (with a scene
/// of nearly that name), a folder.
Result<std::filesystem::path> resolve_scene(const std::string& name_or_path);

/// Reads what a file gives: a scene; the scene in which a mesh falls on a table (drop_in_scene), or
/// that about a robot (robot_scene).
SceneRead read_scene_file(const std::filesystem::path& file, const ReadOptions& options = {});

/// Whether a file that is no robot's is opened as a mesh: it has an ending, and not .json or
/// .jsonc.
bool is_mesh_file(const std::filesystem::path& file);

/// Reads a scene by name or path, or what read_scene_file() makes of another file. What cannot be
/// found is a fault.
SceneRead open_scene(const std::string& name_or_path, const ReadOptions& options = {});

}  // namespace tumble
