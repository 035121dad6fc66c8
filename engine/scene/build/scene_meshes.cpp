#include "engine/scene/build/scene_meshes.hpp"

#include "engine/core/stop.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/scene/build/wrap_cache.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/resources.hpp"

namespace tumble {
namespace {

/// See SceneMeshes::wrapped().
std::shared_ptr<const TriangleMesh> wrap_of_mesh(const std::shared_ptr<const TriangleMesh>& mesh,
                                                 const std::optional<WrapDescription>& wrap,
                                                 const std::string& path, const FaultSink& sink,
                                                 std::vector<std::string>& warnings) {
  if (!mesh || !wrap) return mesh;
  auto made = WrapCache().wrap(mesh, wrap_options(*wrap));
  if (!made) {
    sink(path + ".wrap", made.error().text());
    return nullptr;
  }
  warnings.push_back(path + ": " + wrap_note(*made));
  return std::make_shared<const TriangleMesh>(std::move(made->mesh));
}

}  // namespace

MeshRepresentation representation_of(const MeshModeDescription& d, const Aabb& bounds) {
  MeshRepresentation out;
  out.mode = d.mode.value_or(MeshMode::triangle_mesh);
  out.concavity = d.concavity.value_or(0);
  out.pieces = uint32_t(d.pieces.value_or(0));
  if (out.mode != MeshMode::field) return out;
  DistanceFieldOptions options;
  options.cell = d.cell.value_or(0);
  options.error = d.error.value_or(0);
  out.cell = field_cell(options, bounds);
  return out;
}

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
    const auto mesh = wrap_of_mesh(std::make_shared<const TriangleMesh>(std::move(imported->mesh)),
                                   m.wrap, "meshes." + name, sink, warnings);
    if (!mesh) continue;
    auto parts = mesh_parts(mesh, representation_of(m.how, bounds(*mesh)));
    if (!parts) {
      sink("meshes." + name + ".mode", parts.error().text());
      continue;
    }
    if (!parts->note.empty()) warnings.push_back("meshes." + name + ": " + parts->note);
    meshes_[name] = mesh;
    parts_[name] = *std::move(parts);
  }
}

std::shared_ptr<const TriangleMesh> SceneMeshes::find(const std::string& name) const {
  const auto it = meshes_.find(name);
  return it == meshes_.end() ? nullptr : it->second;
}

std::shared_ptr<const TriangleMesh> SceneMeshes::wrapped(const std::string& name,
                                                         const std::optional<WrapDescription>& wrap,
                                                         const std::string& path,
                                                         const FaultSink& sink,
                                                         std::vector<std::string>& warnings) const {
  const auto mesh = find(name);
  if (!mesh || !wrap) return mesh;
  const WrapOptions o = wrap_options(*wrap);
  const WrapKey key{name, o.gap, o.offset, o.cell};
  if (const auto known = wraps_.find(key); known != wraps_.end()) return known->second;
  auto made = wrap_of_mesh(mesh, wrap, path, sink, warnings);
  if (made) wraps_[key] = made;
  return made;
}

const MeshParts* SceneMeshes::parts(const std::string& name) const {
  const auto it = parts_.find(name);
  return it == parts_.end() ? nullptr : &it->second;
}

bool SceneMeshes::says_first(const TriangleMesh& mesh, const std::string& note) const {
  return said_.emplace(&mesh, note).second;
}

}  // namespace tumble
