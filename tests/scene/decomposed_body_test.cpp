// Meshes that collide as convex pieces. References: the mass of the mesh by its own volume
// integral, where a ball comes to rest in a cup (hulls would keep it out), and the pieces as made
// without a cache.
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/build/piece_cache.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/resources.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/temp_folder.hpp"

#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>

using namespace tumble;
namespace fs = std::filesystem;

namespace {

std::shared_ptr<const TriangleMesh> asset(const std::string& name) {
  const auto file = find_mesh_file({}, name);
  REQUIRE(file.ok());
  auto mesh = import_mesh(*file, {});
  REQUIRE(mesh.ok());
  return std::make_shared<const TriangleMesh>(std::move(mesh->mesh));
}

BuiltScene built_from(const std::string& members) {
  const SceneRead read = read_scene(scene_with(members), "x.json");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  std::vector<Fault> faults;
  WorldDef extras;
  extras.threads = 1;
  auto made = build_world(read.scene, extras, nullptr, &faults);
  INFO(all_text(faults));
  REQUIRE(made.ok());
  return std::move(*made);
}

const RigidBody& named(const BuiltScene& scene, std::string_view name) {
  const auto it = scene.bodies.find(name);
  REQUIRE(it != scene.bodies.end());
  const RigidBody* found = scene.world->body(it->second);
  REQUIRE(found);
  return *found;
}

const std::string two_stars = R"(
  "meshes": {"star": {"file": "star_prism.obj", "mode": "decomposition", "concavity": 0.002}},
  "bodies": {"star": {"shape": {"type": "mesh", "mesh": "star"}, "density": 1000,
                      "repeat": {"type": "stack", "count": 2, "step": [0, 1, 0]},
                      "copies": {"1": {"density": 500}}}})";

}  // namespace

TEST_CASE("a decomposed body has several shapes and the mass of its mesh, its copies too") {
  const BuiltScene scene = built_from(two_stars);
  const MassProperties mesh = mesh_mass(*asset("star_prism.obj"), 1000).value();
  CHECK(named(scene, "star[0]").shapes.size() > 2);
  CHECK(named(scene, "star[0]").mass == doctest::Approx(mesh.mass).epsilon(1e-4));
  CHECK(named(scene, "star[1]").mass == doctest::Approx(mesh.mass / 2).epsilon(1e-4));
}

TEST_CASE("a ball falls into a decomposed cup" * doctest::test_suite("long")) {
  BuiltScene scene = built_from(R"(
    "meshes": {"cup": {"file": "cup.obj", "mode": "decomposition", "concavity": 0.004}},
    "bodies": {
      "floor": {"type": "static", "shape": {"type": "half_space"}},
      "cup": {"shape": {"type": "mesh", "mesh": "cup"}},
      "ball": {"shape": {"type": "sphere", "radius": 0.03}, "position": [0, 0.4, 0]}})");
  for (int i = 0; i < 120; ++i) REQUIRE(scene.world->step().ok());
  CHECK(named(scene, "ball").pose.x.y() < 0.08);
  CHECK(std::fabs(named(scene, "ball").pose.x.x()) < 0.08);
}

TEST_CASE("pieces are kept by content: the same from the cache, made anew when it is damaged") {
  const TempFolder folder;
  const PieceCache cache(folder.path() / "pieces");
  const auto mesh = asset("star_prism.obj");
  ApproximateDecompositionOptions options;
  options.concavity = 0.002;
  const auto same = [](const MeshPieces& a, const MeshPieces& b) {
    if (a.pieces.size() != b.pieces.size() || a.added != b.added) return false;
    for (size_t i = 0; i < a.pieces.size(); ++i)
      if (a.pieces[i].vertices != b.pieces[i].vertices || a.pieces[i].solid != b.pieces[i].solid)
        return false;
    return true;
  };
  const MeshPieces made = PieceCache(fs::path()).pieces(mesh, options).value();
  CHECK(made.pieces.size() > 2);
  CHECK(same(cache.pieces(mesh, options).value(), made));
  std::vector<fs::path> files(fs::directory_iterator(cache.folder()), {});
  REQUIRE(files.size() == 1);
  CHECK(files[0].extension() == ".pieces");
  CHECK(same(cache.pieces(mesh, options).value(), made));
  for (const bool shorten : {false, true}) {
    if (shorten) {
      fs::resize_file(files[0], fs::file_size(files[0]) / 2);
    } else {
      std::fstream(files[0], std::ios::in | std::ios::out | std::ios::binary).seekp(100).put('x');
    }
    CHECK(same(cache.pieces(mesh, options).value(), made));
    CHECK(same(cache.pieces(mesh, options).value(), made));
  }
  // All of a decomposition, exact or not, as it was made.
  const auto same_whole = [](const ConvexDecomposition& a, const ConvexDecomposition& b) {
    if (a.pieces.size() != b.pieces.size() || a.cuts != b.cuts || a.missing != b.missing ||
        a.exact != b.exact || a.hull_volume != b.hull_volume)
      return false;
    for (size_t i = 0; i < a.pieces.size(); ++i)
      if (a.pieces[i].hull.face_vertices != b.pieces[i].hull.face_vertices ||
          a.pieces[i].hull.half_edge_twin != b.pieces[i].hull.half_edge_twin)
        return false;
    return true;
  };
  for (int time = 0; time < 2; ++time) {
    CHECK(same_whole(cache.decomposition(mesh, options).value(),
                     PieceCache(fs::path()).decomposition(mesh, options).value()));
    CHECK(same_whole(cache.exact_decomposition(*mesh, {}).value(),
                     PieceCache(fs::path()).exact_decomposition(*mesh, {}).value()));
  }
  CHECK(std::vector<fs::path>(fs::directory_iterator(cache.folder()), {}).size() == 2);
  options.concavity = 0.003;
  CHECK(cache.pieces(mesh, options).ok());
  CHECK(std::vector<fs::path>(fs::directory_iterator(cache.folder()), {}).size() == 3);
  // A folder that cannot be made costs nothing but time.
  CHECK(same(PieceCache("/dev/null/pieces").pieces(mesh, {.concavity = 0.002}).value(), made));
}

TEST_CASE("keys of pieces are for pieces only, and an open mesh is refused by name") {
  const SceneRead read = read_scene(
      scene_with(R"("meshes": {"a": {"file": "tetra.obj", "concavity": 1}}, "bodies": {})"),
      "x.json");
  CHECK(all_text(read.faults).find("only mode decomposition has pieces") != std::string::npos);
}
