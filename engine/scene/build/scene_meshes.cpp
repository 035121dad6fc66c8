#include "engine/scene/build/scene_meshes.hpp"

#include "engine/core/stop.hpp"
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/resources.hpp"

#include <fmt/format.h>

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
    if (m.mode == MeshMode::decomposition) decompose(name, m, sink, warnings);
    if (m.mode == MeshMode::field) note_field(name, m, warnings);
  }
}

void SceneMeshes::note_field(const std::string& name, const MeshDescription& m,
                             std::vector<std::string>& warnings) {
  DistanceFieldOptions options;
  options.cell = m.cell.value_or(0);
  options.error = m.error.value_or(0);
  const double cell = cells_[name] = field_cell(options, bounds(*meshes_[name]));
  warnings.push_back(
      fmt::format("meshes.{}: approximate: touches as a distance field with cells of {:.3g} m, "
                  "which errs by {:.2g} m at most",
                  name, cell, field_error(cell)));
}

double SceneMeshes::cell(const std::string& name) const {
  const auto it = cells_.find(name);
  return it == cells_.end() ? 0 : it->second;
}

void SceneMeshes::decompose(const std::string& name, const MeshDescription& m,
                            const FaultSink& sink, std::vector<std::string>& warnings) {
  ApproximateDecompositionOptions options;
  options.concavity = m.concavity.value_or(options.concavity);
  if (m.pieces) options.max_pieces = size_t(*m.pieces);
  const auto made = PieceCache().pieces(meshes_[name], options);
  if (!made) {
    sink("meshes." + name + ".mode", made.error().text());
    meshes_.erase(name);
    return;
  }
  if (!made->bound_met)
    warnings.push_back(fmt::format(
        "meshes.{}: {} pieces reach {:.3g} m outside the mesh; a concavity of {:.3g} m takes more",
        name, made->pieces.size(), made->added, made->concavity));
  std::vector<Piece>& out = pieces_[name];
  for (const MeshPieces::Piece& p : made->pieces) {
    auto corners = std::make_shared<TriangleMesh>();
    corners->vertices = p.vertices;
    out.push_back({std::move(corners), p.volume > 0 ? p.solid / p.volume : 1});
  }
}

std::span<const SceneMeshes::Piece> SceneMeshes::pieces(const std::string& name) const {
  const auto it = pieces_.find(name);
  if (it == pieces_.end()) return {};
  return it->second;
}

std::shared_ptr<const TriangleMesh> SceneMeshes::find(const std::string& name) const {
  const auto it = meshes_.find(name);
  return it == meshes_.end() ? nullptr : it->second;
}

}  // namespace tumble
