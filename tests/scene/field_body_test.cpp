// Meshes that collide as distance fields, from scene files. References: the mass of the mesh by its
// own volume integral; the bound of error of interpolation, sqrt(3)/2 cells; where a ball comes to
// rest in a cup (hulls would keep it out).
#include "engine/geometry/distance_field/distance_field.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/resources.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

BuiltScene built_fields(const std::string& members, int threads = 1) {
  const SceneRead read = read_scene(scene_with(members), "x.json");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  std::vector<Fault> faults;
  WorldDef extras;
  extras.threads = threads;
  auto made = build_world(read.scene, extras, nullptr, &faults);
  INFO(all_text(faults));
  REQUIRE(made.ok());
  return std::move(*made);
}

const RigidBody& body_of(const BuiltScene& scene, std::string_view name) {
  const auto it = scene.bodies.find(name);
  REQUIRE(it != scene.bodies.end());
  const RigidBody* found = scene.world->body(it->second);
  REQUIRE(found);
  return *found;
}

const std::string cup_and_ball = R"(
  "meshes": {"cup": {"file": "cup.obj", "mode": "field", "error": 0.004}},
  "bodies": {
    "floor": {"type": "static", "shape": {"type": "half_space"}},
    "cup": {"shape": {"type": "mesh", "mesh": "cup"}, "density": 1000},
    "ball": {"shape": {"type": "sphere", "radius": 0.03}, "position": [0, 0.4, 0]}})";

}  // namespace

TEST_CASE("a mesh of mode field: cells from the error, mass of the mesh, and a warning on load") {
  const BuiltScene scene = built_fields(cup_and_ball);
  const RigidBody& cup = body_of(scene, "cup");
  REQUIRE(cup.shapes.size() == 1);
  const DistanceField* field = cup.shapes[0].shape->field();
  REQUIRE(field);
  CHECK(field->report().band_error <= 0.004);
  CHECK(field->cell() == doctest::Approx(0.004 / (std::sqrt(3.0) / 2)).epsilon(0.01));
  const auto file = find_mesh_file({}, "cup.obj");
  REQUIRE(file.ok());
  const auto mesh = import_mesh(*file, {});
  REQUIRE(mesh.ok());
  CHECK(cup.mass == doctest::Approx(mesh_mass(mesh->mesh, 1000).value().mass).epsilon(1e-9));
  const auto says = [&](const std::string& w) {
    return w.find("cup") != std::string::npos && w.find("approximate") != std::string::npos;
  };
  CHECK(std::ranges::any_of(scene.warnings, says));
}

TEST_CASE("a ball falls into a cup that is a field, and stays") {
  BuiltScene scene = built_fields(cup_and_ball);
  for (int i = 0; i < 180; ++i) REQUIRE(scene.world->step().ok());
  const RigidBody &ball = body_of(scene, "ball"), &cup = body_of(scene, "cup");
  CHECK(ball.pose.x.y() < 0.08);
  CHECK(ball.pose.x.y() > 0.03);
  CHECK(std::hypot(ball.pose.x.x() - cup.pose.x.x(), ball.pose.x.z() - cup.pose.x.z()) < 0.08);
}

TEST_CASE("snapshots hold fields: a world goes on from one as it would have, bit by bit") {
  BuiltScene scene = built_fields(cup_and_ball);
  for (int i = 0; i < 40; ++i) REQUIRE(scene.world->step().ok());
  const auto snapshot = scene.world->save();
  for (int i = 0; i < 40; ++i) REQUIRE(scene.world->step().ok());
  const uint64_t wanted = scene.world->state_hash();
  REQUIRE(scene.world->load(snapshot).ok());
  for (int i = 0; i < 40; ++i) REQUIRE(scene.world->step().ok());
  CHECK(scene.world->state_hash() == wanted);
}

TEST_CASE("keys of fields are for fields only, and an open mesh is refused by name") {
  const auto faults = [](const std::string& mesh) {
    return all_text(
        read_scene(scene_with(R"("meshes": {"a": )" + mesh + R"(}, "bodies": {})"), "x.json")
            .faults);
  };
  CHECK(faults(R"({"file": "tetra.obj", "cell": 1})").find("only mode field has cells") !=
        std::string::npos);
  CHECK(faults(R"({"file": "tetra.obj", "mode": "field", "cell": 1, "error": 1})")
            .find("either cell or error") != std::string::npos);
}
