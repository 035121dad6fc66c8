#include "viewer/app/scene_files.hpp"

#include "engine/core/text.hpp"
#include "engine/scene/resources.hpp"

#include <algorithm>

namespace tumble {
namespace fs = std::filesystem;

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  const auto folder = find_resource("scenes");
  if (!folder) return names;
  std::error_code code;
  for (fs::directory_iterator it(*folder, code), end; !code && it != end; it.increment(code)) {
    const std::string file = it->path().filename().string();
    if (file.ends_with(".json") && !file.ends_with(".schema.json") && !file.starts_with('.'))
      names.push_back(it->path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Result<fs::path> find_scene(std::string_view name_or_file) {
  const fs::path given(name_or_file);
  std::error_code code;
  if (fs::is_regular_file(given, code)) return given;
  if (fs::is_directory(given, code) && given.has_parent_path())
    return Error{ErrorCode::not_found, "this is a folder, not a scene", given.string(), {}};
  const bool bare = name_or_file.find('/') == std::string_view::npos;
  if (bare) {
    if (const auto folder = find_resource("scenes"); folder) {
      for (const std::string& file : {given.string() + ".json", given.string()})
        if (fs::is_regular_file(*folder / file, code)) return *folder / file;
    }
    if (name_or_file.find('.') == std::string_view::npos)
      return Error{ErrorCode::not_found,
                   unknown_name("scene", name_or_file, scene_names()),
                   {},
                   "name a scene of `tumble scenes`, or a file"};
  }
  return Error{ErrorCode::not_found, "there is no such file", given.string(),
               "name a scene of `tumble scenes`, or a file"};
}

}  // namespace tumble
