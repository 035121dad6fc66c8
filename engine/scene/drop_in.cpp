#include "engine/scene/drop_in.hpp"

#include "engine/scene/mesh_files/formats.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/writer.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

ShapeDescription box(const Vec3& size, const Vec3& position) {
  ShapeDescription out;
  out.kind = shape_kind({.type = ShapeType::box, .half_extents = 0.5 * size});
  out.placement.position = position;
  return out;
}

constexpr double table_top = 0.4;     ///< [m]
constexpr double default_size = 0.5;  ///< [m]

BodyDescription table() {
  BodyDescription out;
  out.type = BodyType::fixed;
  out.material.emplace().like = "wood";
  out.colour = colour_from_text("wood");
  constexpr double length = 1.6, width = 1, thickness = 0.08, leg = 0.08;
  constexpr double height = table_top - thickness;
  out.shapes.push_back(box({length, thickness, width}, {0, height + 0.5 * thickness, 0}));
  for (const double x : {-0.5, 0.5})
    for (const double z : {-0.5, 0.5})
      out.shapes.push_back(
          box({leg, height, leg}, {x * (length - 2 * leg), 0.5 * height, z * (width - 2 * leg)}));
  return out;
}

SceneDescription falling_on_table(const std::filesystem::path& file) {
  SceneDescription scene;
  scene.title = file.filename().string();
  scene.description = "A mesh file falls on a table.";
  ParameterDescription size;
  size.value = default_size;
  size.min = 0.01;
  size.max = 100;
  size.doc = "largest extent of the mesh [m]";
  scene.parameters_.add("size", size);
  MeshDescription& mesh = scene.meshes.add("dropped");
  mesh.file = std::filesystem::absolute(file).string();
  mesh.centre = true;

  BodyDescription& floor = scene.bodies.add("floor");
  floor.type = BodyType::fixed;
  floor.shape.emplace().kind = shape_kind({.type = ShapeType::half_space});
  scene.bodies.add("table", table());

  BodyDescription& body = scene.bodies.add("mesh");
  body.shape.emplace().kind = MeshShapeDescription{"dropped", {}, {}};
  body.placement.position = {0, 1.2, 0};
  body.placement.euler_deg = Vec3(20, 30, 10);
  body.material.emplace().like = "plastic";
  body.colour = colour_from_text("orange");
  body.hull_mass = true;

  CameraDescription& camera = scene.cameras.add("main");
  camera.position = {1.4, 1.3, 1.9};
  camera.target = {0, 0.5, 0};
  camera.fov_deg = 40;
  return scene;
}

/// Overrides that make the mesh fall from a quarter of a metre above the table whatever its
/// orientation, and a camera that sees from the floor to the top of the mesh.
std::vector<std::string> fitted_to_size(double extent) {
  constexpr double fall = 0.25;   ///< [m]
  constexpr double turned = 1.1;  ///< half of the diagonal over the extent, with a margin [-]
  const std::string top = fmt::format("({} + {} * size)", table_top + fall, 1.5 * turned);
  // Over the height of the top: height of the camera's target, and its distance, such that both the
  // near leg of the table and the top are in view [-].
  constexpr double target = 0.42, distance = 2;
  const Vec3 towards_camera = Vec3(1.4, 0.8, 1.9).normalized();
  std::vector<std::string> out = {
      fmt::format("meshes.dropped.scale== size / {:.17g}", extent),
      fmt::format("bodies.mesh.position.y== {} + {} * size", table_top + fall, turned),
      fmt::format("cameras.main.target.y== {} * {}", target, top)};
  for (int axis = 0; axis < 3; ++axis)
    out.push_back(fmt::format("cameras.main.position.{}== {} * {}", "xyz"[axis],
                              distance * towards_camera[axis] + (axis == 1 ? target : 0), top));
  return out;
}

/// Why a file with this ending cannot be opened; "": it may be a mesh.
std::string fault_of_kind(const std::filesystem::path& file) {
  const auto format = mesh_format_of(file);
  if (format) return {};
  const std::string extension = file.extension().string();
  if (extension == ".tumble" || extension == ".zip")
    return "this is no pack of a scene: it is no ZIP archive (`tumble pack` makes one)";
  return "this is no scene, pack, robot or mesh: scenes end in .json, packs in .tumble, robots in "
         ".urdf or .xml; for meshes " +
         format.error().cure;
}

}  // namespace

SceneRead drop_in_scene(const std::filesystem::path& mesh_file, const ReadOptions& options) {
  SceneRead out;
  if (std::string fault = fault_of_kind(mesh_file); !fault.empty()) {
    out.faults.push_back({mesh_file.string(), 0, {}, std::move(fault)});
    return out;
  }
  const auto imported = import_mesh(mesh_file);
  if (!imported) {
    Error why = imported.error();
    why.place.clear();  // the fault names the file itself
    out.faults.push_back({mesh_file.string(), 0, {}, why.text()});
    return out;
  }
  const double extent = bounds(imported->mesh).extent().maxCoeff();
  // Made as text, so that overrides and parameters work as in any scene.
  ReadOptions all;
  all.overrides = fitted_to_size(extent);
  all.overrides.insert(all.overrides.end(), options.overrides.begin(), options.overrides.end());
  return read_scene(write_scene(falling_on_table(mesh_file)), mesh_file.string(), all);
}

}  // namespace tumble
