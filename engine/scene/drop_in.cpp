#include "engine/scene/drop_in.hpp"

#include "engine/scene/mesh_import.hpp"
#include "engine/scene/writer.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace tumble {
namespace {

ShapeDescription box(const Vec3& size, const Vec3& position) {
  ShapeDescription out;
  out.kind = BoxShapeDescription{size};
  out.placement.position = position;
  return out;
}

BodyDescription table(double top) {
  BodyDescription out;
  out.type = BodyType::fixed;
  out.material.emplace().like = "wood";
  out.colour = colour_from_text("wood");
  constexpr double side = 2.4, thickness = 0.1, leg = 0.12;
  out.shapes.push_back(box({side, thickness, side}, {0, top - 0.5 * thickness, 0}));
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0})
      out.shapes.push_back(
          box({leg, top - thickness, leg}, {1.08 * x, 0.5 * (top - thickness), 1.08 * z}));
  return out;
}

SceneDescription falling_on_table(const std::filesystem::path& file) {
  constexpr double top = 0.8;
  SceneDescription scene;
  scene.title = file.filename().string();
  scene.description = "A mesh file falls on a table.";
  MeshDescription& mesh = scene.meshes.add("dropped");
  mesh.file = std::filesystem::absolute(file).string();
  mesh.centre = true;

  BodyDescription& ground = scene.bodies.add("ground");
  ground.type = BodyType::fixed;
  ground.shape.emplace().kind = HalfSpaceShapeDescription{};
  scene.bodies.add("table", table(top));

  BodyDescription& body = scene.bodies.add("dropped");
  body.shape.emplace().kind = MeshShapeDescription{"dropped"};
  body.placement.position = {0, top + 1.1, 0};
  body.placement.euler_deg = Vec3(25, 0, 15);
  body.material.emplace().like = "plastic";
  body.colour = colour_from_text("coral");
  body.look.pattern = 0.25;
  body.hull_mass = true;

  CameraDescription& camera = scene.cameras.add("main");
  camera.position = {2.6, 2.3, 3.4};
  camera.target = {0, 0.95, 0};
  return scene;
}

}  // namespace

SceneRead drop_in_scene(const std::filesystem::path& mesh_file, const ReadOptions& options) {
  const auto imported = import_mesh(mesh_file);
  SceneRead out;
  if (!imported) {
    out.faults.push_back({mesh_file.string(), 0, {}, imported.error().message});
    return out;
  }
  SceneDescription scene = falling_on_table(mesh_file);
  const double extent = bounds(imported->mesh).extent().maxCoeff();
  scene.meshes.items[0].value.scale = extent > 0 ? std::clamp(1 / extent, 1e-9, 1e9) : 1;
  ParameterDescription size, copies;
  size.value = 1;
  size.doc = "largest extent of the mesh [m]";
  copies.value = 1;
  copies.doc = "how many fall";
  scene.parameters_.add("size", size);
  scene.parameters_.add("copies", copies);
  BodyDescription& body = scene.bodies.items.back().value;
  StackRepetition stack;
  stack.count = 1;
  body.repeat.emplace_back().kind = stack;

  // Through the text, so that overrides and parameters work as in any scene.
  ReadOptions all;
  all.overrides = {fmt::format("meshes.dropped.scale== size * {:.17g}", 1 / extent),
                   "bodies.dropped.position.y== 0.9 + 1.1 * size",
                   "bodies.dropped.repeat[0].count=$copies",
                   "bodies.dropped.repeat[0].step=[0, \"= 1.3 * size\", 0]"};
  all.overrides.insert(all.overrides.end(), options.overrides.begin(), options.overrides.end());
  return read_scene(write_scene(scene), mesh_file.string(), all);
}

}  // namespace tumble
