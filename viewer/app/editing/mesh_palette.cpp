#include "viewer/app/editing/mesh_palette.hpp"

#include "engine/scene/mesh_import.hpp"
#include "viewer/app/editing/mesh_cure.hpp"

#include <chrono>
#include <cmath>

#include <nlohmann/json.hpp>

namespace tumble {
namespace {

/// If a mesh is this many times larger or smaller than the view, its file is assumed to have other
/// units.
constexpr double another_unit = 8;

bool is_utf8(const std::string& text) {
  try {
    (void)nlohmann::json(text).dump();
    return true;
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

/// 1, or the power of ten that brings the mesh nearest to the size of the view.
double scale_for(const Aabb& box, double view_size) {
  const double size = box.extent().maxCoeff();
  if (!(size > 0 && view_size > 0)) return 1;
  const double ratio = view_size / size;
  if (ratio < another_unit && ratio > 1 / another_unit) return 1;
  return std::pow(10.0, std::round(std::log10(ratio)));
}

Result<std::shared_ptr<const PaletteMesh>> read_palette_mesh(const NewMesh& chosen,
                                                             double view_size) {
  if (!is_utf8(chosen.file))
    return Error{ErrorCode::invalid_argument,
                 "the name of this file is not UTF-8, as all text in scenes is",
                 {},
                 "rename the file or its folder"};
  PaletteMesh out;
  out.chosen = chosen;
  ImportOptions options;
  options.centre = true;
  auto imported = import_mesh(chosen.file, options);
  if (!imported) return imported.error();
  out.scale = scale_for(bounds(imported->mesh), view_size);
  if (out.scale != 1) {
    // Cleaned up as for a scene that gives this scale.
    options.scale = out.scale;
    imported = import_mesh(chosen.file, options);
    if (!imported) return imported.error();
  }
  out.mesh = std::make_shared<const TriangleMesh>(std::move(imported->mesh));
  auto parts = mesh_parts(out.mesh, {.mode = chosen.mode});
  if (!parts) return with_cure_in_window(parts.error());
  out.parts = *std::move(parts);
  if (stop_requested()) return stopped_error();
  return std::make_shared<const PaletteMesh>(std::move(out));
}

}  // namespace

void MeshPalette::choose(const NewMesh& mesh, double view_size, bool beside) {
  if (wanted_ == mesh) return;
  // The file being read is no longer wanted: it is cancelled, and the new one started by a later
  // call.
  if (reading_.valid() && reading_.wait_for(std::chrono::seconds(0)) == std::future_status::timeout)
    return stop_.request();
  stop_.clear();
  wanted_ = mesh;
  ready_.reset();
  fault_.clear();
  reading_ =
      std::async(beside ? std::launch::async : std::launch::deferred, [this, mesh, view_size] {
        const Stoppable scope(&stop_);
        return read_palette_mesh(mesh, view_size);
      });
}

std::shared_ptr<const PaletteMesh> MeshPalette::ready() {
  if (reading_.valid() &&
      reading_.wait_for(std::chrono::seconds(0)) != std::future_status::timeout) {
    Read read = reading_.get();
    if (stop_.requested())
      wanted_.reset();  // may be chosen anew
    else if (read)
      ready_ = *read;
    else
      fault_ = read.error().text();
  }
  return ready_;
}

}  // namespace tumble
