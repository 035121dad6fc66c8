#include "viewer/app/window/screenshots.hpp"

#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/free_name.hpp"
#include "viewer/capture/png.hpp"

namespace tumble {

Result<std::filesystem::path> Screenshots::save(Renderer& renderer, const std::string& scene) {
  if (Status s = make_folder(folder_); !s) return s.error();
  Image image;
  if (Status s = renderer.read_back(image); !s) return s.error();
  const std::filesystem::path path =
      free_name(folder_, "tumble-" + (scene.empty() ? "scene" : scene), ".png");
  if (Status s = write_png(path, without_alpha(image)); !s) return s.error();
  saved_.push_back(path);
  return path;
}

}  // namespace tumble
