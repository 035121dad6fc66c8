#include "viewer/app/scenes/scene_files.hpp"

#include "engine/scene/catalogue.hpp"

namespace tumble {

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const CatalogueEntry& entry : scene_catalogue()) names.push_back(entry.name);
  return names;
}

Result<std::filesystem::path> find_scene(std::string_view name_or_file) {
  return resolve_scene(std::string(name_or_file));
}

}  // namespace tumble
