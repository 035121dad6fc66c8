// Wraps that take the place of open meshes in scenes. References: the mass of the wrap by its own
// volume integral, what is made without a cache, and bounds for the shell about a sheet.
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/build/wrap_cache.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/temp_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace tumble;

namespace {

/// A scene beside a file of one sheet of 1 m by 1 m.
struct SheetScene {
  TempFolder folder;
  SheetScene() {
    std::ofstream(folder.path() / "sheet.obj") << "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n";
  }
  SceneRead read(const std::string& members) const {
    return read_scene(scene_with(members), (folder.path() / "x.json").string());
  }
};

}  // namespace

TEST_CASE(
    "an open mesh of a scene has a mass when it is wrapped, and says how far it was changed") {
  const SheetScene files;
  const std::string body =
      R"("bodies": {"a": {"shape": {"type": "mesh", "mesh": "s"}, "density": 1000}})";
  const std::string wrap = R"("wrap": {"gap": 0.01, "offset": 0.1, "cell": 0.05})";
  const SceneRead by_mesh =
      files.read(R"("meshes": {"s": {"file": "sheet.obj", )" + wrap + "}}, " + body);
  const SceneRead by_shape = files.read(
      R"("meshes": {"s": "sheet.obj"}, "bodies": {"a": {"shape": {"type": "mesh", "mesh": "s", "mode": "decomposition", )" +
      wrap + R"(}, "density": 1000}})");
  // A shell of 1 m by 1 m, .1 m to either side; with sharp or cut edges.
  constexpr double d = 0.1, least = 2 * d, most = 2 * d * (1 + 2 * d) * (1 + 2 * d);
  for (const SceneRead* read : {&by_mesh, &by_shape}) {
    INFO(all_text(read->faults));
    REQUIRE(read->ok());
    std::vector<Fault> faults;
    auto made = build_world(read->scene, {}, nullptr, &faults);
    INFO(all_text(faults));
    REQUIRE(made.ok());
    const RigidBody& a = *made->world->body(made->bodies.find("a")->second);
    CHECK(a.mass > 1000 * least);
    CHECK(a.mass < 1000 * most * 1.02);
    const bool told = std::ranges::any_of(made->warnings, [](const std::string& w) {
      return w.find("wrapped in") != std::string::npos &&
             w.find("outside the mesh") != std::string::npos;
    });
    CHECK(told);
  }
  // Without a wrap the refusal names it.
  const SceneRead bare = files.read(
      R"("meshes": {"s": "sheet.obj"}, "bodies": {"a": {"shape": {"type": "mesh", "mesh": "s", "mode": "field"}}})");
  REQUIRE(bare.ok());
  std::vector<Fault> faults;
  CHECK_FALSE(build_world(bare.scene, {}, nullptr, &faults).ok());
  CHECK(all_text(faults).find("wrap") != std::string::npos);
  const SceneRead fine =
      files.read(R"("meshes": {"s": {"file": "sheet.obj", "wrap": {"cell": 1e-6}}}, )" + body);
  REQUIRE(fine.ok());
  faults.clear();
  CHECK_FALSE(build_world(fine.scene, {}, nullptr, &faults).ok());
  CHECK(all_text(faults).find("meshes.s.wrap") != std::string::npos);
}

TEST_CASE("shapes that ask for the same wrap of a mesh share it, and it is told of once") {
  const SheetScene files;
  const auto body = [](const std::string& name, const std::string& gap) {
    return '"' + name + R"(": {"shape": {"type": "mesh", "mesh": "s", "mode": "convex_hull", )" +
           R"("wrap": {"offset": 0.2, "cell": 0.1, "gap": )" + gap + R"(}}, "density": 1000})";
  };
  const SceneRead read =
      files.read(R"("meshes": {"s": "sheet.obj"}, "bodies": {)" + body("a", "0.01") + ", " +
                 body("b", "0.01") + ", " + body("c", "0.02") + "}");
  INFO(all_text(read.faults));
  REQUIRE(read.ok());
  std::vector<Fault> faults;
  auto made = build_world(read.scene, {}, nullptr, &faults);
  INFO(all_text(faults));
  REQUIRE(made.ok());
  CHECK(std::ranges::count_if(made->warnings, [](const std::string& w) {
          return w.find("wrapped in") != std::string::npos;
        }) == 2);
}

TEST_CASE("wraps are kept by content: the same from the cache, made anew when it is damaged") {
  const SheetScene files;
  const auto imported = import_mesh(files.folder.path() / "sheet.obj");
  REQUIRE(imported.ok());
  const auto mesh = std::make_shared<const TriangleMesh>(imported->mesh);
  WrapOptions options;
  options.cell = 0.1;
  const WrapCache cache(files.folder.path() / "wraps");
  const WrappedMesh made = WrapCache(std::filesystem::path()).wrap(mesh, options).value();
  const auto same = [&] {
    const WrappedMesh kept = cache.wrap(mesh, options).value();
    return kept.mesh.vertices == made.mesh.vertices && kept.mesh.triangles == made.mesh.triangles &&
           kept.report.added == made.report.added && kept.report.bound == made.report.bound;
  };
  CHECK(same());
  CHECK(same());
  using Files = std::vector<std::filesystem::path>;
  const Files kept(std::filesystem::directory_iterator(cache.folder()), {});
  REQUIRE(kept.size() == 1);
  std::filesystem::resize_file(kept[0], std::filesystem::file_size(kept[0]) / 2);
  CHECK(same());
  options.gap = 0.5;
  CHECK(cache.wrap(mesh, options).ok());
  CHECK(Files(std::filesystem::directory_iterator(cache.folder()), {}).size() == 2);
  // What cannot be made is refused for what was given, and nothing is kept of it.
  options.gap = -1;
  const auto refused = cache.wrap(mesh, options);
  REQUIRE_FALSE(refused.ok());
  CHECK(refused.error().text().find("gap of a wrap must be >= 0") != std::string::npos);
  CHECK_FALSE(cache.wrap(std::make_shared<const TriangleMesh>(), {}).ok());
  CHECK(Files(std::filesystem::directory_iterator(cache.folder()), {}).size() == 2);
}
