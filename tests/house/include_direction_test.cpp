// Dependencies point one way: core < math < geometry < collision < dynamics < world < scene <
// viewer, and between the rooms of dynamics and of the program. Reference: the text of every
// #include in engine/ and viewer/.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

#include <doctest/doctest.h>

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 8> levels = {"core",     "math",  "geometry", "collision",
                                                    "dynamics", "world", "scene",    "viewer"};

/// Position in `levels` of a path such as engine/math/x.hpp or viewer/ui/x.hpp; -1 if neither.
int level_of(const std::string& path) {
  static const std::regex pattern("^(?:engine/([a-z_]+)|(viewer))/.*");
  std::smatch m;
  if (!std::regex_match(path, m, pattern)) return -1;
  const std::string name = m[1].matched ? m[1].str() : m[2].str();
  const auto it = std::find(levels.begin(), levels.end(), name);
  return it == levels.end() ? -1 : int(it - levels.begin());
}

struct Rooms {
  std::string_view folder;
  std::vector<std::string_view> names;  ///< lowest first: the table of the folder's README.md

  /// Position of the room of a path such as engine/dynamics/rows/x.hpp; -1 if it is in none.
  int of(std::string_view path) const {
    if (!path.starts_with(folder)) return -1;
    path.remove_prefix(folder.size());
    const auto it = std::find(names.begin(), names.end(), path.substr(0, path.find('/')));
    return it == names.end() ? -1 : int(it - names.begin());
  }
};
const Rooms dynamics{"engine/dynamics/",
                     {"simd", "bodies", "particles", "forces", "sph", "rows", "joints", "contact",
                      "islands", "realtime", "grains", "event"}};
const Rooms program{
    "viewer/app/",
    {"scenes", "verify", "session", "editing", "window", "mesh", "bench", "simulate", "commands"}};

/// Calls f(file, what it includes) for every quoted include of the .hpp and .cpp files of a folder.
template <class F>
void for_each_include(const fs::path& root, const char* top, const F& f) {
  const std::regex include("^\\s*#\\s*include\\s*\"([^\"]+)\".*");
  for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
    const auto extension = entry.path().extension();
    if (extension != ".hpp" && extension != ".cpp") continue;
    const std::string here = fs::relative(entry.path(), root).generic_string();
    std::ifstream in(entry.path());
    std::string line;
    for (std::smatch m; std::getline(in, line);)
      if (std::regex_match(line, m, include)) f(here, m[1].str());
  }
}

}  // namespace

TEST_CASE("the rooms of dynamics include each other in one direction") {
  int includes = 0;
  for_each_include(TUMBLE_SOURCE_DIR, "engine/dynamics", [&](const auto& here, const auto& other) {
    if (!other.starts_with("engine/dynamics/")) return;
    ++includes;
    REQUIRE_MESSAGE(dynamics.of(here) >= 0, here, " is in no room of dynamics");
    REQUIRE_MESSAGE(dynamics.of(other) >= 0, here, " includes ", other, ", which is in no room");
    CHECK_MESSAGE(dynamics.of(other) <= dynamics.of(here), here, " includes ", other);
  });
  CHECK(includes > 100);
}

TEST_CASE("the rooms of the program include each other in one direction") {
  int includes = 0;
  for_each_include(TUMBLE_SOURCE_DIR, "viewer", [&](const auto& here, const auto& other) {
    if (program.of(other) < 0) return;
    const bool above = here.starts_with("viewer/app/") && program.of(here) < 0;  // main, commands
    includes += above ? 0 : 1;
    CHECK_MESSAGE((above || program.of(other) <= program.of(here)), here, " includes ", other);
  });
  CHECK(includes > 100);
}

TEST_CASE("includes go from high levels to low ones only") {
  const fs::path root = TUMBLE_SOURCE_DIR;
  int includes = 0;
  for (const char* top : {"engine", "viewer"}) {
    for_each_include(root, top, [&](const std::string& here, const std::string& included) {
      const int own = level_of(here), other = level_of(included);
      REQUIRE_MESSAGE(own >= 0, here, " is outside the house");
      ++includes;
      CHECK_MESSAGE(other >= 0, here, " includes \"", included,
                    "\": write it from the root, engine/... or viewer/...");
      CHECK_MESSAGE(other <= own, here, " (", levels[size_t(own)], ") includes ", included);
      CHECK_MESSAGE(fs::exists(root / included), here, " includes ", included);
    });
  }
  CHECK(includes > 10);
}
