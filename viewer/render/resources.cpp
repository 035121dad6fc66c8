#include "viewer/render/resources.hpp"

#include <cstdlib>
#include <string>
#include <vector>

namespace tumble {
namespace fs = std::filesystem;

Result<fs::path> resource_root() {
  std::vector<fs::path> places;
  if (const char* given = std::getenv("TUMBLE_DATA"); given && *given) {
    places = {given};  // an explicit wish is never second-guessed
  } else {
    std::error_code ignored;
    const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
    if (!program.empty()) places.push_back(program.parent_path().parent_path() / "share/tumble");
    places.push_back(TUMBLE_SOURCE_DIR);
    places.push_back(TUMBLE_INSTALL_DATADIR);
  }
  std::string tried;
  for (const fs::path& place : places) {
    std::error_code ignored;
    if (fs::is_directory(place / "shaders", ignored)) return place;
    tried += (tried.empty() ? "" : ", ") + place.string();
  }
  return Error{ErrorCode::not_found, "no folder with Tumble's shaders, scenes and assets", tried,
               "install Tumble, or set TUMBLE_DATA to the folder that holds shaders/"};
}

Result<fs::path> resource_path(std::string_view relative) {
  auto root = resource_root();
  if (!root) return root.error();
  const fs::path path = *root / relative;
  std::error_code ignored;
  if (!fs::exists(path, ignored))
    return Error{ErrorCode::not_found, "missing", path.string(), "reinstall Tumble"};
  return path;
}

}  // namespace tumble
