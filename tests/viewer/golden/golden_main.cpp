// Runs one shipped scene for two seconds and holds it against what is recorded in tests/golden:
//   state hash     equal everywhere, and for 1, 2 and 4 threads: recorded with two; in the gate a
//                  scene runs with one of these numbers, by its name, with all counts with each
//   draw-list hash equal everywhere
//   pixels         equal where the renderer's name and version are; else by the rule of `compare`
//
// usage: golden SCENE           0 equal, 1 different, 77 nothing recorded yet
//        golden --bless [SCENE...]   records anew (all scenes unless named); run it on purpose only
#include "tests/support/run_program.hpp"
#include "tests/support/scale.hpp"
#include "tests/support/temp_folder.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/compare.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace tumble {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

const fs::path golden = fs::path(TUMBLE_SOURCE_DIR) / "tests/golden";

/// What a run of a scene gives.
struct Observed {
  std::string state_hash, draw_hash, image_hash, renderer;
  fs::path picture;
};

int fail(const std::string& scene, const std::string& what) {
  fmt::print(stderr, "{}: {}\n", scene, what);
  return 1;
}

ProgramRun tumble(const std::vector<std::string>& arguments) {
  ProgramOptions options;
  options.timeout = 280;
  return run_program(fs::path(TUMBLE_BINARY_DIR) / "bin/tumble", arguments, options);
}

constexpr std::array thread_counts = {"2", "1", "4"};

/// Renders the scene at 0 s and 2 s (two frames at half a frame a second).
std::optional<Observed> observe(const std::string& scene, const fs::path& folder,
                                const char* threads) {
  const ProgramRun run = tumble({"render", scene, "-o", folder.string(), "--frames", "2", "--fps",
                                 "0.5", "--size", "480x270", "--threads", threads, "--quiet"});
  if (run.code != 0) {
    fmt::print(stderr, "{}: tumble render gave {}\n{}", scene, run.code, run.err);
    return {};
  }
  const auto text = read_file(folder / "frames.json");
  const Json list = text ? Json::parse(*text, nullptr, false) : Json();
  if (!list.is_object() || list["frames"].size() != 2) return {};
  const Json& frame = list["frames"][1];
  return Observed{
      frame["state_hash"], frame["draw_hash"], frame["image_hash"],
      list["renderer"].get<std::string>() + " | " + list["gl_version"].get<std::string>(),
      folder / frame["file"].get<std::string>()};
}

Json read_hashes() {
  const auto text = read_file(golden / "hashes.json");
  Json json = text ? Json::parse(*text, nullptr, false) : Json();
  if (!json.is_object()) json = {{"scenes", Json::object()}};
  return json;
}

int judge_pixels(const std::string& scene, const Observed& seen, const Json& wanted) {
  if (seen.renderer == wanted["renderer"]) {
    if (seen.image_hash == wanted["image_hash"]) return 0;
    fmt::print(stderr, "{}: same renderer, but the pixels differ\n", scene);
  }
  const fs::path diff = fs::path(TUMBLE_BINARY_DIR) / "golden" / (scene + "_diff.png");
  CompareOptions options;
  options.diff = diff;
  if (auto made = make_folder(diff.parent_path()); !made) return fail(scene, made.error().text());
  const auto outcome = compare_paths(golden / (scene + ".png"), seen.picture, options);
  if (const auto* failure = std::get_if<CompareFailure>(&outcome))
    return fail(scene, failure->error.text());
  const FileComparison& f = std::get<ComparisonReport>(outcome).files.front();
  fmt::print(stderr, "{}: {:.4f} % of pixels differ, largest cluster {}, see {}\n", scene,
             100 * f.difference.share(), f.difference.largest_cluster, diff.string());
  return f.equal && seen.renderer != wanted["renderer"] ? 0 : 1;
}

int judge(const std::string& scene) {
  const Json hashes = read_hashes();
  if (hashes["scenes"].empty()) {
    fmt::print(stderr, "nothing is recorded yet: run `golden --bless`\n");
    return 77;
  }
  if (!hashes["scenes"].contains(scene))
    return fail(scene,
                "not in tests/golden/hashes.json: look at it, then `golden --bless " + scene + "`");
  const Json& wanted = hashes["scenes"][scene];
  TempFolder folder;
  const auto letters = std::accumulate(scene.begin(), scene.end(), size_t{0});
  const char* own = thread_counts[letters % thread_counts.size()];
  const auto seen = observe(scene, folder.path(), own);
  if (!seen) return 1;
  int bad = 0;
  for (const char* threads : thread_counts) {
    if (threads == own || !test::all_counts()) continue;
    const ProgramRun run =
        tumble({"simulate", scene, "--seconds", "2", "--threads", threads, "--hash"});
    if (run.out != seen->state_hash + "\n")
      bad |= fail(scene, fmt::format("with {} threads the state hash is {}, not {}", threads,
                                     run.out, seen->state_hash));
  }
  if (seen->state_hash != wanted["state_hash"])
    bad |= fail(scene, "state hash " + seen->state_hash + ", recorded is " +
                           wanted["state_hash"].get<std::string>());
  if (seen->draw_hash != wanted["draw_hash"])
    bad |= fail(scene, "draw-list hash " + seen->draw_hash + ", recorded is " +
                           wanted["draw_hash"].get<std::string>());
  return bad | judge_pixels(scene, *seen, wanted);
}

int bless(std::vector<std::string> scenes) {
  const bool all = scenes.empty();
  if (all)
    for (const char* shipped : {"scenes", "scenes/lessons"})
      for (const auto& entry : fs::directory_iterator(fs::path(TUMBLE_SOURCE_DIR) / shipped))
        if (const std::string name = entry.path().filename().string();
            name.ends_with(".json") && !name.ends_with(".schema.json"))
          scenes.push_back(entry.path().stem().string());
  std::sort(scenes.begin(), scenes.end());
  Json hashes = read_hashes();
  if (all) hashes["scenes"] = Json::object();
  for (const std::string& scene : scenes) {
    TempFolder folder;
    const auto seen = observe(scene, folder.path(), thread_counts[0]);
    if (!seen) return 1;
    hashes["scenes"][scene] = {{"state_hash", seen->state_hash},
                               {"draw_hash", seen->draw_hash},
                               {"image_hash", seen->image_hash},
                               {"renderer", seen->renderer}};
    const auto picture = read_file(seen->picture);
    if (!picture || !write_file(golden / (scene + ".png"), *picture))
      return fail(scene, "cannot write into " + golden.string());
    fmt::print("{} {}\n", scene, seen->state_hash);
  }
  const Status written = write_file(golden / "hashes.json", hashes.dump(2) + "\n");
  return written ? 0 : fail("hashes.json", written.error().text());
}

}  // namespace
}  // namespace tumble

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  if (!arguments.empty() && arguments[0] == "--bless")
    return tumble::bless({arguments.begin() + 1, arguments.end()});
  if (arguments.size() != 1) {
    std::fputs("usage: golden SCENE | golden --bless [SCENE...]\n", stderr);
    return 2;
  }
  return tumble::judge(arguments[0]);
}
