#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/mesh_import.hpp"
#include "viewer/app/load_scene.hpp"

#include <nlohmann/json.hpp>

namespace tumble {

Result<std::string> mesh_scene_text(const std::filesystem::path& mesh_file) {
  const auto mesh = import_mesh(mesh_file);
  if (!mesh) return mesh.error();
  const Aabb box = bounds(mesh->mesh);
  const double extent = box.extent().maxCoeff();
  const double scale = extent > 0 ? 0.5 / extent : 1;
  const bool solid = mesh_mass(mesh->mesh).ok();

  using Json = nlohmann::ordered_json;
  std::error_code code;
  const std::string file = std::filesystem::absolute(mesh_file, code).string();
  Json body = {{"position", {0, 1.2, 0}},
               {"euler_deg", {20, 30, 10}},
               {"shape", {{"type", "mesh"}, {"mesh", "dropped"}}},
               {"colour", "#E8743B"},
               {"hull_mass", !solid}};
  const Json table = {{"type", "static"},
                      {"position", {0, 0.36, 0}},
                      {"shape", {{"type", "box"}, {"size", {1.6, 0.08, 1.0}}}},
                      {"colour", "#8A6242"}};
  const Json floor = {{"type", "static"}, {"shape", {{"type", "half_space"}}}};
  const Json scene = {
      {"tumble_scene", 1},
      {"title", mesh_file.filename().string()},
      {"meshes", {{"dropped", {{"file", file}, {"scale", scale}, {"centre", true}}}}},
      {"bodies", {{"mesh", body}, {"table", table}, {"floor", floor}}},
      {"cameras",
       {{"main", {{"position", {1.4, 1.3, 1.9}}, {"target", {0, 0.5, 0}}, {"fov_deg", 40}}}}}};
  return scene.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace tumble
