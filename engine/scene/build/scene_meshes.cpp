#include "engine/scene/build/scene_meshes.hpp"

#include "engine/core/stop.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/resources.hpp"

namespace tumble {

SceneMeshes::SceneMeshes(const SceneDescription& scene, const FaultSink& sink,
                         std::vector<std::string>& warnings) {
  const std::filesystem::path folder = scene.source ? scene.source->folder : "";
  for (const auto& [name, m] : scene.meshes.items) {
    if (stop_requested()) break;
    const auto file = find_mesh_file(folder, m.file);
    if (!file) {
      sink("meshes." + name + ".file", file.error().message);
      continue;
    }
    const ImportOptions options{m.scale, m.stretch.value_or(Vec3::Ones()), m.up, m.centre, m.weld};
    auto imported = import_mesh(*file, options);
    if (!imported) {
      sink("meshes." + name + ".file", imported.error().text());
      continue;
    }
    for (const std::string& note : imported->notes)
      warnings.push_back("meshes." + name + ": " + note);
    meshes_[name] = std::make_shared<const TriangleMesh>(std::move(imported->mesh));
  }
}

std::shared_ptr<const TriangleMesh> SceneMeshes::find(const std::string& name) const {
  const auto it = meshes_.find(name);
  return it == meshes_.end() ? nullptr : it->second;
}

}  // namespace tumble
