// Damaged scenes, robots and mesh files, all the way: read, built, one tick; read, cleaned,
// measured. The reference is the promise itself: an answer or an error, never a crash, within
// bounds of time and memory. Batches run in processes of their own; one that fails is run again
// case by case, so that the case is named. (tests/scene/hostile_test.cpp damages the reader's input
// alone, with more kinds, and tests/scene/robots/robot_mutations_test.cpp that of robots.)
#include "engine/core/random.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/reader.hpp"
#include "engine/scene/robot_scene.hpp"
#include "engine/world/world.hpp"
#include "tests/fuzz/damaged.hpp"
#include "tests/fuzz/mesh_files.hpp"
#include "tests/scene/child_process.hpp"
#include "tests/scene/robots/whole_robots.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/process_limits.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/why_not.hpp"

#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

using namespace tumble;
namespace fs = std::filesystem;

namespace {

constexpr int batch = 50;
constexpr unsigned case_seconds = 20;  // of processor, of the slowest case
constexpr size_t case_megabytes = 3072;

/// Reads, builds and steps one damaged scene.
void try_scene(int number) {
  const SceneRead read = read_scene(damaged_scene(uint64_t(number)), "x.json");
  if (!read.ok()) return;
  WorldDef extras;
  extras.threads = 1;
  const auto built = build_world(read.scene, extras);
  if (built) (void)built->world->step();
}

/// A mesh of 76 faces, small enough that most changes hit what matters.
const std::vector<NamedFile>& mesh_files() {
  static const std::vector<NamedFile> files = [] {
    const auto star = import_mesh(TUMBLE_SOURCE_DIR "/assets/meshes/star_prism.obj", {});
    REQUIRE(star.ok());
    return mesh_in_every_format(star->mesh);
  }();
  return files;
}

Result<ImportedMesh> import_bytes(const fs::path& file, const std::string& bytes,
                                  const ImportOptions& options) {
  std::ofstream(file, std::ios::binary) << bytes;
  auto mesh = import_mesh(file, options);
  fs::remove(file);
  return mesh;
}

/// Reads one damaged mesh file and asks for its mass.
void try_mesh(const NamedFile& whole, Random& random, const fs::path& folder) {
  // In files of binary numbers there is some text too: headers, JSON.
  const std::string bytes = whole.text || random.below(4) == 0 ? damaged_text(whole.bytes, random)
                                                               : damaged_bytes(whole.bytes, random);
  ImportOptions options;
  if (random.below(3) == 0) options.weld = 1e-4;
  const auto mesh = import_bytes(folder / whole.name, bytes, options);
  if (mesh) (void)mesh_mass(mesh->mesh, 1000);
}

/// Reads one damaged robot file as a scene, builds and steps it.
void try_robot(int number, const fs::path& folder) {
  Random random(uint64_t(number), 8);
  static const NamedFile files[] = {
      {"a.urdf", test::whole_urdf},
      {"b.xml", test::whole_mjcf},
      {"c.urdf", file_text(TUMBLE_SOURCE_DIR "/scenes/robots/arm.urdf")}};
  const NamedFile& whole = files[random.below(3)];
  const fs::path file = folder / whole.name;
  std::ofstream(file, std::ios::binary) << damaged_text(whole.bytes, random);
  const SceneRead read = robot_scene(file);
  if (!read.ok()) return;
  WorldDef extras;
  extras.threads = 1;
  const auto built = build_world(read.scene, extras);
  if (built) (void)built->world->step();
}

/// Runs f(number) for many numbers in children; CHECKs that all come back.
template <class F>
void run_all(int count, const F& f) {
  for (int first = 0; first < count; first += batch) {
    const auto run = [&](int from, int to, unsigned seconds) {
      return run_in_child(
          [&] {
            limit_process(seconds, case_megabytes);
            for (int i = from; i < to; ++i) f(i);
            return std::string("done");
          },
          4 * seconds);
    };
    const int last = std::min(first + batch, count);
    const ChildOutcome all = run(first, last, 2 * case_seconds);
    if (all.text == "done") continue;
    for (int i = first; i < last; ++i) {
      const ChildOutcome one = run(i, i + 1, case_seconds);
      CHECK_MESSAGE(one.text == "done",
                    fmt::format("case {}: {}", i,
                                one.timed_out ? "takes too long" : "crashed or ran out of memory"));
    }
  }
}

/// 10,000 when the full counts are asked for, a part where a build is instrumented; 100 in the
/// gate.
int cases() {
  return test::scale_is_set() ? test::scaled_count(10000) : 100;
}

}  // namespace

TEST_CASE("damaged scenes are refused or run, within bounds of time and memory") {
  run_all(cases(), try_scene);
}

TEST_CASE("the mesh that will be damaged is the same from every format") {
  const TempFolder folder;
  const double volume =
      mesh_mass(import_mesh(TUMBLE_SOURCE_DIR "/assets/meshes/star_prism.obj", {})->mesh)->mass;
  for (const NamedFile& file : mesh_files()) {
    CAPTURE(file.name);
    const auto mesh = import_bytes(folder / file.name, file.bytes, {});
    REQUIRE_MESSAGE(mesh.ok(), test::why_not(mesh));
    // The node of glTF doubles the height; STL and glTF have single precision.
    const double nodes = file.name.ends_with(".gltf") || file.name.ends_with(".glb") ? 2 : 1;
    CHECK(mesh_mass(mesh->mesh)->mass == doctest::Approx(nodes * volume).epsilon(1e-6));
  }
}

TEST_CASE("damaged mesh files are refused or read, within bounds of time and memory") {
  const TempFolder folder;
  run_all(cases(), [&](int i) {
    Random random(uint64_t(i), 6);
    const auto& files = mesh_files();
    try_mesh(files[random.below(uint32_t(files.size()))], random, folder.path());
  });
}

TEST_CASE("damaged robot files are refused or run, within bounds of time and memory") {
  const TempFolder folder;
  run_all(cases(), [&](int i) { try_robot(i, folder.path()); });
}
