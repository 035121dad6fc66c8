// Damaged scenes and mesh files, all the way: read, built, one tick; read, cleaned, measured. The
// reference is the promise itself: an answer or an error, never a crash, within bounds of time and
// memory. Batches run in processes of their own; one that fails is run again case by case, so that
// the case is named. (tests/scene/hostile_test.cpp damages the reader's input alone, with more
// kinds.)
#include "engine/core/random.hpp"
#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/scene/build.hpp"
#include "engine/scene/mesh_import.hpp"
#include "engine/scene/reader.hpp"
#include "engine/world/world.hpp"
#include "tests/fuzz/damaged.hpp"
#include "tests/fuzz/judge_scene.hpp"
#include "tests/scene/child_process.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/temp_folder.hpp"

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

/// Reads one damaged mesh file and asks for its mass.
void try_mesh(int number, const fs::path& folder) {
  Random random(uint64_t(number), 6);
  static const char* files[] = {"washer.obj", "l_bracket.obj", "star_prism.obj", "arch_stone.off"};
  const std::string name = files[random.below(4)];
  const std::string text = file_text(TUMBLE_SOURCE_DIR "/assets/meshes/" + name);
  const fs::path file = folder / (std::to_string(number) + "_" + name);
  std::ofstream(file, std::ios::binary) << damaged_text(text, random);
  ImportOptions options;
  if (random.below(3) == 0) options.weld = 1e-4;
  const auto mesh = import_mesh(file, options);
  if (mesh) (void)mesh_mass(mesh->mesh, 1000);
  fs::remove(file);
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

TEST_CASE("damaged mesh files are refused or read, within bounds of time and memory") {
  const TempFolder folder;
  run_all(cases(), [&](int i) { try_mesh(i, folder.path()); });
}
