// Dependencies point one way: core < math < geometry < collision < dynamics < world < scene <
// viewer. Reference: the text of every #include in engine/ and viewer/.
#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>

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

}  // namespace

TEST_CASE("includes go from high levels to low ones only") {
  const fs::path root = TUMBLE_SOURCE_DIR;
  const std::regex include("^\\s*#\\s*include\\s*\"([^\"]+)\".*");
  int files = 0, includes = 0;
  for (const char* top : {"engine", "viewer"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / top)) {
      const auto extension = entry.path().extension();
      if (extension != ".hpp" && extension != ".cpp") continue;
      const std::string here = fs::relative(entry.path(), root).generic_string();
      const int own = level_of(here);
      REQUIRE_MESSAGE(own >= 0, here, " is outside the house");
      ++files;
      std::ifstream in(entry.path());
      std::string line;
      while (std::getline(in, line)) {
        std::smatch m;
        if (!std::regex_match(line, m, include)) continue;
        ++includes;
        const int other = level_of(m[1].str());
        CHECK_MESSAGE(other >= 0, here, " includes \"", m[1].str(),
                      "\": write it from the root, engine/... or viewer/...");
        CHECK_MESSAGE(other <= own, here, " (", levels[size_t(own)], ") includes ", m[1].str());
        CHECK_MESSAGE(fs::exists(root / m[1].str()), here, " includes ", m[1].str());
      }
    }
  }
  CHECK(files > 10);
  CHECK(includes > 10);
}
