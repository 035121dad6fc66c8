#include "viewer/app/screenshots.hpp"

#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

/// The first name FOLDER/STEM-000.png that does not exist yet.
std::filesystem::path free_name(const std::filesystem::path& folder, const std::string& stem) {
  std::error_code ignored;
  for (int i = 0;; ++i) {
    const std::filesystem::path path = folder / fmt::format("{}-{:03}.png", stem, i);
    if (i > 99999 || !std::filesystem::exists(path, ignored)) return path;
  }
}

}  // namespace

Result<std::filesystem::path> Screenshots::save(Renderer& renderer, const std::string& scene) {
  if (Status s = make_folder(folder_); !s) return s.error();
  Image image;
  if (Status s = renderer.read_back(image); !s) return s.error();
  const std::filesystem::path path =
      free_name(folder_, "tumble-" + (scene.empty() ? "scene" : scene));
  if (Status s = write_png(path, without_alpha(image)); !s) return s.error();
  saved_.push_back(path);
  return path;
}

}  // namespace tumble
