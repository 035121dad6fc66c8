#include "engine/scene/resources.hpp"

#include "engine/core/text.hpp"

#include <algorithm>
#include <cstdlib>

namespace tumble {
namespace fs = std::filesystem;
namespace {

bool is_file(const fs::path& p) {
  std::error_code error;
  return fs::is_regular_file(p, error);
}

std::vector<std::string> file_names(const fs::path& folder) {
  std::vector<std::string> out;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::vector<fs::path> resource_roots() {
  std::vector<fs::path> roots;
  std::error_code error;
  const auto add = [&](const fs::path& p) {
    if (!p.empty() && fs::is_directory(p, error) &&
        std::find(roots.begin(), roots.end(), p) == roots.end())
      roots.push_back(p);
  };
  if (const char* env = std::getenv("TUMBLE_RESOURCE_DIR")) add(env);
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!program.empty()) add(program.parent_path().parent_path() / "share" / "tumble");
#ifdef TUMBLE_SOURCE_ROOT
  add(TUMBLE_SOURCE_ROOT);
#endif
  return roots;
}

Result<fs::path> find_resource(const fs::path& relative) {
  std::string looked;
  for (const fs::path& root : resource_roots()) {
    std::error_code error;
    if (fs::exists(root / relative, error)) return root / relative;
    looked += (looked.empty() ? "" : ", ") + (root / relative).string();
  }
  return Error{ErrorCode::not_found,
               "there is no '" + relative.string() + "' (looked for " +
                   (looked.empty() ? "no folder" : looked) + ")",
               {},
               "set TUMBLE_RESOURCE_DIR to the folder that holds scenes/ and assets/"};
}

Result<fs::path> find_mesh_file(const fs::path& scene_folder, const std::string& file) {
  const fs::path given(file);
  std::vector<fs::path> candidates;
  std::vector<std::string> names;
  if (given.is_absolute()) {
    candidates.push_back(given);
  } else {
    const fs::path folder = scene_folder.empty() ? fs::path(".") : scene_folder;
    candidates.push_back(folder / given);
    for (const fs::path& root : resource_roots())
      candidates.push_back(root / "assets" / "meshes" / given);
  }
  for (const fs::path& c : candidates) {
    if (is_file(c)) return c;
    for (std::string& name : file_names(c.parent_path())) names.push_back(std::move(name));
  }
  std::string message = "there is no mesh file '" + file + "'";
  if (const std::string near = nearest_word(given.filename().string(), names); !near.empty())
    message += ", did you mean '" + near + "'?";
  message += " Looked for";
  for (const fs::path& c : candidates) message += " " + c.string();
  return Error{ErrorCode::not_found, std::move(message), {}, {}};
}

fs::path user_folder(const char* variable, const char* under_home) {
  const char* folder = std::getenv(variable);
  const char* home = std::getenv("HOME");
  // By the specification, a path that is not absolute must be ignored.
  if (folder && fs::path(folder).is_absolute()) return folder;
  if (home && fs::path(home).is_absolute()) return fs::path(home) / under_home;
  return {};
}

}  // namespace tumble
