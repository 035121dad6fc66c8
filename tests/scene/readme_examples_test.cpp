// Examples of the READMEs: each is read, built and run for a second without an error. Whole scenes
// stand in fenced blocks of JSON; parts of scenes, `"key": {...}` in the text, are put into a scene
// in which the names that they use exist. A key that this test does not know fails it.
#include "engine/scene/build.hpp"
#include "engine/world/world.hpp"
#include "tests/scene/scene_text.hpp"
#include "tests/support/why_not.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <vector>

using namespace tumble;

namespace {

const std::filesystem::path root = TUMBLE_SOURCE_DIR;

std::vector<std::filesystem::path> readmes() {
  std::vector<std::filesystem::path> out{root / "README.md"};
  for (const char* top : {"engine", "viewer", "assets", "scenes", "shaders", "tests"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top))
      if (entry.path().filename() == "README.md") out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

/// What stands between fences that begin with ```json or ```jsonc.
std::vector<std::string> fenced(const std::string& text) {
  std::vector<std::string> out;
  for (size_t at = text.find("```json"); at != std::string::npos; at = text.find("```json", at)) {
    const size_t begin = text.find('\n', at) + 1, end = text.find("\n```", begin);
    out.push_back(text.substr(begin, end - begin));
    at = end + 4;
  }
  return out;
}

/// Code in the text that is one key with an object: `"key": {...}`.
std::vector<std::string> parts_of_scenes(const std::string& text) {
  std::vector<std::string> out;
  for (size_t at = text.find("`\""); at != std::string::npos; at = text.find("`\"", at + 1)) {
    const size_t end = text.find('`', at + 1);
    const std::string code = text.substr(at + 1, end - at - 1);
    const size_t colon = code.find("\": {");
    if (colon != std::string::npos && code.find('"', 1) == colon && code.back() == '}')
      out.push_back(code);
  }
  return out;
}

/// Bodies of the names that the examples use.
const std::string bodies =
    "\"ground\": {\"type\": \"static\", \"shape\": {\"type\": \"half_space\"}},\n"
    "\"frame\": {\"type\": \"static\", \"shape\": {\"type\": \"box\", \"size\": [0.1, 2, 0.1]},"
    " \"position\": [0.3, 1.1, 0]},\n"
    "\"leaf\": {\"shape\": {\"type\": \"box\", \"size\": [0.8, 1.8, 0.05]},"
    " \"position\": [0.85, 1.1, 0]},\n"
    "\"gem\": {\"shape\": {\"type\": \"cylinder\", \"radius\": 0.3,"
    " \"height\": 0.5}, \"position\": [5, 3, 0]},\n"
    "\"box\": {\"shape\": {\"type\": \"box\", \"size\": [1, 1, 1]}, \"position\": [5, 1, 0.3]}";

/// The scene around a part: by key where it belongs.
std::string scene_around(const std::string& part) {
  const std::string key = part.substr(1, part.find('"', 1) - 1);
  static const std::string all = "\"bodies\": {" + bodies + "}";
  static const std::string host =
      "{\"shape\": {\"type\": \"sphere\", \"radius\": 0.04}, \"position\": [0, 1, 0], ";
  static const std::string system =
      "\"particles\": {\"host\": {\"fill\": {\"type\": \"lattice\","
      " \"centre\": [0, 3, 0], \"size\": [0.5, 0.5, 0.5], \"spacing\": 0.1}, ";
  const std::map<std::string, std::string> around{
      {"meshes", all + ", "},
      {"materials", all + ", "},
      {"joints", all + ", "},
      {"forces", all + ", "},
      {"parameters", all + ", "},
      {"microscope", all + ", "},
      {"robots", all + ", "},
      {"particles", all + ", "},
      {"emitters", all + ", \"particles\": {\"water\": {}}, "},
      {"sinks", all + ", "},
      {"sensors", all + ", "},
      {"assertions", all + ", "},
      {"lesson", all + ", "},
      {"repeat", "\"bodies\": {" + bodies + ", \"host\": " + host},
      {"copies", "\"bodies\": {" + bodies + ", \"host\": " + host +
                     "\"repeat\": {\"type\": \"stack\", \"count\": 20, \"step\": [0, 0.3, 0]}, "},
      {"springs", all + ", " + system},
      {"look", all + ", " + system}};
  const auto found = around.find(key);
  REQUIRE_MESSAGE(found != around.end(), "no scene is known around ", part);
  const std::string open = found->second + part;
  const bool nested = key == "repeat" || key == "copies" || key == "springs" || key == "look";
  return scene_with(open + (nested ? "}}" : ""));
}

/// A file that an example of the program's README expects beside the scene stands in by another.
std::string with_files_that_exist(std::string text) {
  for (size_t at = text.find("thing.obj"); at != std::string::npos; at = text.find("thing.obj"))
    text.replace(at, 9, "gear.obj");
  return text;
}

void run_scene(const std::string& text) {
  INFO(text);
  const SceneRead read = read_scene(with_files_that_exist(text), "example.json");
  REQUIRE_MESSAGE(read.ok(), all_text(read.faults));
  auto built = build_world(read.scene);
  REQUIRE_MESSAGE(built.ok(), test::why_not(built));
  World& world = *built->world;
  const double seconds = 1.0 / std::max(1, 10 / scaled_count(10));
  const Energies start = world.frame()->stats.energies;
  while (world.time() < seconds) {
    const auto step = world.step();
    REQUIRE_MESSAGE(step.ok(), test::why_not(step));
  }
  // Nothing else in the examples does work: motion cannot have more than there was to fall for, and
  // what emitters and motors gave.
  const Energies end = world.frame()->stats.energies;
  double given = 0;
  for (const LedgerLine line : {LedgerLine::emission, LedgerLine::motors})
    given += world.frame()->ledger->line(line).total().balance;
  CHECK(end.total() <= start.total() + given + 0.01 * std::fabs(start.total()) + 1e-3);
}

}  // namespace

TEST_CASE("every scene in the READMEs is sound and runs") {
  int found = 0;
  for (const std::filesystem::path& readme : readmes())
    for (const std::string& text : fenced(file_text(readme.string()))) {
      INFO(readme.string());
      run_scene(text);
      ++found;
    }
  CHECK(found >= 2);
}

TEST_CASE("every part of a scene in the READMEs is sound and runs") {
  int found = 0;
  for (const std::filesystem::path& readme : readmes())
    for (const std::string& part : parts_of_scenes(file_text(readme.string()))) {
      INFO(readme.string());
      run_scene(scene_around(part));
      ++found;
    }
  CHECK(found >= 9);
}
