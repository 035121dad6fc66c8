#include "engine/scene/catalogue.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/drop_in.hpp"
#include "engine/scene/json_tree.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/scene/resources.hpp"
#include "engine/scene/robot_files/robot_parts.hpp"
#include "engine/scene/robot_scene.hpp"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <sstream>

#include <unistd.h>

namespace tumble {
namespace fs = std::filesystem;
namespace {

constexpr const char* scene_folders[] = {"scenes", "scenes/lessons"};

std::string text_of(const JsonNode& root, std::string_view key) {
  const JsonNode* node = root.find(key);
  return node && node->is(JsonNode::Kind::string) ? node->string : std::string();
}

CatalogueEntry entry_of(const fs::path& file) {
  CatalogueEntry out;
  out.name = out.title = file.stem().string();
  out.file = file;
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  FaultList ignored;
  if (const auto root = parse_json(text.str(), file.string(), ignored)) {
    if (std::string title = text_of(*root, "title"); !title.empty()) out.title = std::move(title);
    out.description = text_of(*root, "description");
    out.category = text_of(*root, "category");
  }
  return out;
}

/// An error if something is at this path, or may be, that cannot be reached or read.
Status may_be_read(const fs::path& path) {
  std::error_code error;
  const auto type = fs::status(path, error);
  const bool nothing = type.type() == fs::file_type::not_found;
  if (!nothing && !error && fs::is_regular_file(type) && ::access(path.c_str(), R_OK) != 0)
    error = std::error_code(errno, std::generic_category());
  if (nothing || !error) return {};
  const bool forbidden = error == std::errc::permission_denied;
  return Error{ErrorCode::io, "cannot be read: " + error.message(), path.string(),
               forbidden ? "ask its owner for the right to read it, and to enter its folders" : ""};
}

}  // namespace

std::vector<CatalogueEntry> scene_catalogue() {
  std::vector<CatalogueEntry> out;
  for (const fs::path& root : resource_roots()) {
    for (const char* folder : scene_folders) {
      std::error_code error;
      for (const auto& file : fs::directory_iterator(root / folder, error)) {
        const fs::path& path = file.path();
        if (path.extension() != ".json" || path.filename() == "tumble.schema.json") continue;
        const bool known = std::any_of(out.begin(), out.end(), [&](const CatalogueEntry& e) {
          return e.name == path.stem().string();
        });
        if (!known) out.push_back(entry_of(path));
      }
    }
  }
  std::sort(out.begin(), out.end(),
            [](const CatalogueEntry& a, const CatalogueEntry& b) { return a.name < b.name; });
  return out;
}

Result<fs::path> resolve_scene(const std::string& name_or_path) {
  const char* cure = "name a scene of `tumble scenes`, or a file";
  const fs::path given(name_or_path);
  std::error_code error;
  if (name_or_path == "-")
    return Error{ErrorCode::not_found, "scenes are not read from standard input", name_or_path,
                 "write it into a file, and name that"};
  if (const Status open = may_be_read(given); !open) return open.error();
  if (fs::is_regular_file(given, error)) return is_pack_file(given) ? unpack(given) : given;
  const Error folder{ErrorCode::not_found, "this is a folder, not a scene", name_or_path,
                     "name a file in it"};
  if (fs::is_directory(given, error) && given.has_parent_path()) return folder;
  if (given.has_parent_path() && fs::exists(given, error))
    return Error{ErrorCode::not_found, "this is a device or a pipe, not a file", name_or_path,
                 cure};
  if (name_or_path.find('/') == std::string::npos) {
    for (const char* folder : scene_folders)
      for (const std::string& file : {name_or_path + ".json", name_or_path})
        if (auto found = find_resource(fs::path(folder) / file);
            found && fs::is_regular_file(*found, error))
          return found;
    if (fs::is_directory(given, error)) return folder;
    if (name_or_path.find('.') == std::string::npos) {
      std::vector<std::string> names;
      for (const CatalogueEntry& e : scene_catalogue()) names.push_back(e.name);
      return Error{ErrorCode::not_found, unknown_name("scene", name_or_path, names), {}, cure};
    }
  }
  return Error{ErrorCode::not_found, "there is no such file", name_or_path, cure};
}

SceneRead read_scene_file(const fs::path& file, const ReadOptions& options) {
  if (is_robot_file(file)) return robot_scene(file, options);
  return is_mesh_file(file) ? drop_in_scene(file, options) : load_scene(file, options);
}

bool is_mesh_file(const fs::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return !extension.empty() && extension != ".json" && extension != ".jsonc";
}

SceneRead open_scene(const std::string& name_or_path, const ReadOptions& options) {
  const auto file = resolve_scene(name_or_path);
  if (!file) {
    SceneRead out;
    Error e = file.error();
    e.place.clear();
    out.faults.push_back({name_or_path, 0, {}, e.text()});
    return out;
  }
  return read_scene_file(*file, options);
}

}  // namespace tumble
